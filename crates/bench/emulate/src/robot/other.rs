//! Requests of the manufacturer's client that the client of `twintac-rig` does not use.

use glam::DVec3;
use twintac_rig::TcpPose;
use twintac_rig::xarm::ResponseState;

use super::Controller;

impl Controller {
    /// The payload of the response to a function, or the state bits of its refusal. The function
    /// codes are those of its `x_config.py`.
    pub(super) fn other(&mut self, function: u8, payload: &[u8]) -> Result<Vec<u8>, ResponseState> {
        let floats = |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        match (function, payload) {
            (2, _) => Ok(self.serial_numbers()),
            // Whether reports have currents in place of torques: no.
            (5, _) => Ok(vec![0]),
            // Jerks and accelerations, world frame, gravity, saved settings: they have no effect
            // here.
            (31..=34 | 39 | 40 | 51 | 66 | 73, _) => Ok(Vec::new()),
            (35, _) if payload.len() >= 24 => {
                let [x, y, z, roll, pitch, yaw] = numbers(payload).map(f64::from);
                self.tcp_offset.position_mm = DVec3::new(x, y, z);
                self.tcp_offset.roll_pitch_yaw_rad = DVec3::new(roll, pitch, yaw);
                Ok(Vec::new())
            }
            (36, _) if payload.len() >= 16 => {
                self.payload = numbers(payload);
                Ok(Vec::new())
            }
            (37, [sensitivity @ 0..=5, ..]) => {
                self.collision_sensitivity = *sensitivity;
                Ok(Vec::new())
            }
            (38, [sensitivity @ 0..=5, ..]) => {
                self.teach_sensitivity = *sensitivity;
                Ok(Vec::new())
            }
            // Whether a pose is out of reach.
            (46, _) if payload.len() >= 24 => {
                let [x, y, z] = numbers(payload).map(f64::from);
                let pose = TcpPose {
                    position_mm: DVec3::new(x, y, z),
                    ..self.pose()
                };
                Ok(vec![u8::from(!self.settings().reaches(&pose))])
            }
            // Torques of the joints.
            (55, _) => Ok(floats(&[0.0; 7])),
            // The pose, with its rotation as an axis and an angle.
            (91, _) => {
                let pose = self.pose();
                let turn = pose.base_from_tool().to_scaled_axis();
                let position_mm = pose.position_mm;
                let all = [
                    position_mm.x,
                    position_mm.y,
                    position_mm.z,
                    turn.x,
                    turn.y,
                    turn.z,
                ];
                Ok(floats(&all.map(|number| number as f32)))
            }
            _ => Err(ResponseState::INVALID),
        }
    }

    /// Serial numbers of arm and control box, each terminated by a zero.
    fn serial_numbers(&self) -> Vec<u8> {
        let mut numbers = self.settings().version.split(',').skip(2);
        let mut text = format!(
            "{}\0{}\0",
            numbers.next().unwrap_or_default(),
            numbers.next().unwrap_or_default()
        )
        .into_bytes();
        text.resize(40, 0);
        text
    }
}

/// Little-endian floats. Floats beyond the end of the bytes are zero.
fn numbers<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let (words, _) = bytes.as_chunks::<4>();
    std::array::from_fn(|index| words.get(index).map_or(0.0, |word| f32::from_le_bytes(*word)))
}
