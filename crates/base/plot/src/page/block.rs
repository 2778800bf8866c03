//! What a page is made of.

use crate::Scene;

/// A word in a pill that says where figures come from. `real`, `emulated` and `simulated` have colours of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Badge(pub String);

/// A run of text, or a badge within it.
#[derive(Clone, Debug)]
pub enum Span {
    /// Words.
    Words(String),
    /// A badge.
    Badge(Badge),
}

/// A paragraph; one without words is left out.
#[derive(Clone, Debug, Default)]
pub struct Paragraph(pub Vec<Span>);

impl<T: Into<String>> From<T> for Paragraph {
    fn from(words: T) -> Self {
        let words = words.into();
        Paragraph(if words.is_empty() {
            Vec::new()
        } else {
            vec![Span::Words(words)]
        })
    }
}

/// A name with its value as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fact {
    /// What it is.
    pub name: String,
    /// Its value with the unit.
    pub value: String,
}

impl Fact {
    /// A fact from anything that reads as text.
    pub fn new(name: impl Into<String>, value: impl Into<String>) -> Self {
        Fact {
            name: name.into(),
            value: value.into(),
        }
    }
}

/// A value in large print over its name.
#[derive(Clone, Debug, Default)]
pub struct Card {
    /// What is shown.
    pub fact: Fact,
    /// Where it comes from.
    pub badge: Badge,
}

/// A picture with its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The picture.
    pub scene: Scene,
    /// Where its numbers come from, if it shows any.
    pub badge: Option<Badge>,
    /// What it shows.
    pub caption: String,
    /// The same in numbers, below it.
    pub table: Option<Table>,
}

/// A cell of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// On the left.
    Words(String),
    /// On the right.
    Number(String),
    /// Where the row's numbers come from.
    Badge(Badge),
}

/// A row of a table.
#[derive(Clone, Debug)]
pub struct Row {
    /// From left to right.
    pub cells: Vec<Cell>,
    /// Whether the row is emphasised.
    pub is_chosen: bool,
}

impl From<Vec<Cell>> for Row {
    fn from(cells: Vec<Cell>) -> Self {
        Row {
            cells,
            is_chosen: false,
        }
    }
}

/// A table; one without rows is left out.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// From top to bottom.
    pub rows: Vec<Row>,
}

/// A thing on a page.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(Paragraph),
    /// Values with their names, large, beside each other.
    Cards(Vec<Card>),
    /// Values with their names, as a list.
    Facts(Vec<Fact>),
    /// Pictures beside each other where there is room.
    Figures(Vec<Figure>),
    /// A picture that takes the whole width.
    Wide(Box<Figure>),
    /// A table.
    Table(Table),
    /// A list of what the reader should mind, with its heading.
    Warnings(&'static str, Vec<String>),
    /// A command line.
    Command(String),
    /// A text that is shown on demand, with its heading.
    Details(&'static str, String),
}
