//! Settings of the emulated board and its faults.

use phystac::{Chip, Transfer, WiringError};
use twintac_emulate::i2c::{BoardSettings, PartSettings};
use twintac_emulate::{EmulateError, ScheduledFault};
use twintac_firmware::{Form, NodeSettings};

/// Taxels of the emulated board.
pub const N_TAXELS: usize = 8;

/// An emulated board: eight chips behind a switch, and the options with which its firmware is
/// built.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The bus and what is on it.
    pub board: BoardSettings,
    /// Faults.
    pub faults: Vec<ScheduledFault>,
    /// How the firmware reads the chips.
    pub node: NodeSettings<N_TAXELS>,
    /// The form of its output until the host changes it.
    pub form: Form,
    /// Position of the resting tool that the physics receives, in the robot's base frame, mm.
    pub tool_mm: [f64; 3],
    /// Whether a pin is wired to the switch's RESET.
    pub is_reset_wired: bool,
}

/// Why a board cannot be emulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    /// A setting of the bus or a fault that is not valid.
    #[error(transparent)]
    Emulate(#[from] EmulateError),
    /// A wiring of the taxels that is not valid.
    #[error("the taxels cannot be wired so: {0}")]
    Wiring(#[from] WiringError),
}

impl Setup {
    /// Eight chips of a kind behind a switch at 0x70, on a bus of 400 kHz. Output is CSV, at the
    /// highest rate, without faults. A CPS135B has the scale of the emulated ones. The tool presses
    /// the surface of [`Hertz`](twintac_emulate::Hertz) by 1 mm.
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
