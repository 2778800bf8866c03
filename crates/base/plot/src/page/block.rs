//! Building blocks of a page.

use crate::Scene;

/// A coloured label that states the provenance of figures. `real`, `emulated` and `simulated` have
/// colours of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Badge(pub String);

/// A run of text, or a badge within text.
#[derive(Clone, Debug)]
pub enum Span {
    /// Words.
    Words(String),
    /// A badge.
    Badge(Badge),
}

/// A paragraph; it is left out if it has no words.
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

/// A name with a value as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fact {
    /// Name of the quantity.
    pub name: String,
    /// Its value with the unit.
    pub value: String,
}

impl Fact {
    /// A fact from anything that converts to text.
    pub fn new(name: impl Into<String>, value: impl Into<String>) -> Self {
        Fact {
            name: name.into(),
            value: value.into(),
        }
    }
}

/// A value in large print above its name.
#[derive(Clone, Debug, Default)]
pub struct Card {
    /// What is shown.
    pub fact: Fact,
    /// Its provenance.
    pub badge: Badge,
}

/// A picture with its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The picture.
    pub scene: Scene,
    /// Provenance of its numbers, if it shows any.
    pub badge: Option<Badge>,
    /// What it shows.
    pub caption: String,
    /// The same data in numbers, shown below it.
    pub table: Option<Table>,
}

/// A cell of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// Words, aligned left.
    Words(String),
    /// A number, aligned right.
    Number(String),
    /// Provenance of the row's numbers.
    Badge(Badge),
}

/// A row of a table.
#[derive(Clone, Debug)]
pub struct Row {
    /// From left to right.
    pub cells: Vec<Cell>,
    /// Whether the row is emphasized.
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

/// A table; it is left out if it has no rows.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// From top to bottom.
    pub rows: Vec<Row>,
}

/// Values of several sources at marks on a plan, frame by frame: a reader chooses a press and moves
/// through it with a slider. It is left out if it has no presses.
#[derive(Clone, Debug, Default)]
pub struct Replay {
    /// Unit of the values.
    pub unit: String,
    /// Corners of the plan, mm: the lowest and the highest.
    pub bounds_mm: [[f64; 2]; 2],
    /// Name and location of each mark, mm.
    pub marks: Vec<(String, [f64; 2])>,
    /// Name and provenance of each source.
    pub sources: Vec<(String, Badge)>,
    /// The presses.
    pub presses: Vec<ReplayPress>,
}

/// A press of a [`Replay`].
#[derive(Clone, Debug, Default)]
pub struct ReplayPress {
    /// Its name.
    pub name: String,
    /// Location, mm.
    pub place_mm: [f64; 2],
    /// Depth at each frame, mm.
    pub depth_mm: Vec<f64>,
    /// Values; NaN where one is missing; `[n_sources][n_frames][n_marks]`.
    pub values: Vec<Vec<Vec<f64>>>,
}

/// An element of a page.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(Paragraph),
    /// Values with their names, in large print beside each other.
    Cards(Vec<Card>),
    /// Values with their names, as a list.
    Facts(Vec<Fact>),
    /// Pictures beside each other if there is room.
    Figures(Vec<Figure>),
    /// A picture over the whole width.
    Wide(Box<Figure>),
    /// Presses to move through.
    Replay(Replay),
    /// A table.
    Table(Table),
    /// A heading, and a list of warnings.
    Warnings(&'static str, Vec<String>),
    /// A command line.
    Command(String),
    /// A heading, and a text that is shown on demand.
    Details(&'static str, String),
}
