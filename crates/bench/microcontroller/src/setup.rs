//! What is soldered to the emulated board, and what goes wrong with it.

use phystac::{Chip, Transfer, WiringError};
use twintac_emulate::i2c::{BoardSettings, PartSettings};
use twintac_emulate::{EmulateError, ScheduledFault};
use twintac_firmware::{Form, NodeSettings};

/// Taxels of the emulated board.
pub const N_TAXELS: usize = 8;

/// An emulated board: eight chips behind a switch, and what its firmware is told when it is built.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The bus and what is on it.
    pub board: BoardSettings,
    /// What goes wrong.
    pub faults: Vec<ScheduledFault>,
    /// How the firmware reads.
    pub node: NodeSettings<N_TAXELS>,
    /// How it writes until the host says otherwise.
    pub form: Form,
    /// Where the tool rests that the physics is told of, in the robot's base frame, mm.
    pub tool_mm: [f64; 3],
    /// Whether a pin is wired to the switch's RESET.
    pub is_reset_wired: bool,
}

/// Why a board cannot be emulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    /// A setting of the bus, or a fault, that makes no sense.
    #[error(transparent)]
    Emulate(#[from] EmulateError),
    /// Taxels that cannot be told apart.
    #[error("the taxels cannot be wired so: {0}")]
    Wiring(#[from] WiringError),
}

impl Setup {
    /// Eight chips of a kind behind a switch at 0x70, on a bus of 400 kHz; CSV, as quick as it can be, nothing goes wrong. A CPS135B counts as the
    /// emulated ones do. The tool presses the surface of [`Hertz`](twintac_emulate::Hertz) by 1 mm.
    ///
    /// # Panics
    /// Never: eight channels of a switch are different places.
    #[must_use]
    pub fn of(chip: Chip) -> Self {
        let channels = 0..N_TAXELS as u8;
        let board = BoardSettings {
            parts: channels
                .map(|channel| PartSettings::on_channel(chip.data().name, channel))
                .collect(),
            ..BoardSettings::default()
        };
        let mut node = NodeSettings::of(chip).expect("eight channels of a switch are different places");
        let scale = board.barometer.counts_per_pa as u16;
        node.transfer = (!chip.data().knows_its_scale).then(|| Transfer::per_pa(scale));
        Self {
            board,
            faults: Vec::new(),
            node,
            form: Form::Csv,
            tool_mm: [200.0, 0.0, 99.0],
            is_reset_wired: true,
        }
    }
}
