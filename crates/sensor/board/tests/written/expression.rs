//! S-expressions.

/// A word or a list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expression {
    Word(String),
    List(Vec<Expression>),
}

impl Expression {
    pub(crate) fn parse(text: &str) -> Self {
        let mut open: Vec<Vec<Self>> = vec![Vec::new()];
        let mut chars = text.chars().peekable();
        while let Some(c) = chars.next() {
            match c {
                '(' => open.push(Vec::new()),
                ')' => {
                    let list = open.pop().unwrap();
                    open.last_mut().unwrap().push(Self::List(list));
                }
                '"' => {
                    let mut word = String::new();
                    while let Some(c) = chars.next().filter(|c| *c != '"') {
                        word.push(if c == '\\' { chars.next().unwrap() } else { c });
                    }
                    open.last_mut().unwrap().push(Self::Word(word));
                }
                c if c.is_whitespace() => {}
                c => {
                    let mut word = c.to_string();
                    while let Some(c) = chars.next_if(|c| !c.is_whitespace() && !"()\"".contains(*c)) {
                        word.push(c);
                    }
                    open.last_mut().unwrap().push(Self::Word(word));
                }
            }
        }
        assert_eq!(open.len(), 1, "brackets do not match");
        open.pop().unwrap().pop().unwrap()
    }

    pub(crate) fn items(&self) -> &[Self] {
        match self {
            Self::List(items) => items,
            Self::Word(_) => &[],
        }
    }

    pub(crate) fn word(&self, index: usize) -> &str {
        match self.items().get(index) {
            Some(Self::Word(word)) => word,
            _ => "",
        }
    }

    pub(crate) fn number(&self, index: usize) -> f64 {
        self.word(index).parse().unwrap_or(0.0)
    }

    /// The lists in it that begin with the word `name`.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Self> {
        self.items().iter().filter(move |item| item.word(0) == name)
    }

    pub(crate) fn first(&self, name: &str) -> Option<&Self> {
        self.items().iter().find(|item| item.word(0) == name)
    }
}
