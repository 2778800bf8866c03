//! The engine that answers requests.

use std::sync::Arc;

use twintac_line::Description;
use twintac_sensor::{IndenterFile, Sensor};

use crate::arrays::{Array, Arrays};
use crate::desk::Desk;
use crate::error::EngineError;
use crate::files::Files;
use crate::outline::outline;
use crate::press::Press;
use crate::request::{Offer, Refused, Reply, Request};
use crate::sensor_reply::SensorReply;
use crate::surrogate::Surrogate;

/// The state of a page: its sensor, the pressed gel and its surrogate, stored files, and the
/// connected sensor.
#[derive(Default)]
pub struct Engine {
    files: Files,
    sensor: Option<Arc<Sensor>>,
    press: Option<Press>,
    surrogate: Option<Surrogate>,
    offer: Offer,
    desk: Option<Desk>,
    arrays: Arrays,
}

impl Engine {
    /// Answers a request, a JSON text, with a JSON text. `bytes` is the file that the request
    /// stores, or what came over a line. If something is wrong, the answer is `{"error": "…"}`, and
    /// the engine stays as it was.
    pub fn answer(&mut self, request: &str, bytes: &[u8]) -> String {
        let answered = self
            .reply(request, bytes)
            .and_then(|reply| Ok(serde_json::to_string(&reply)?));
        answered.unwrap_or_else(|error| {
            let error = error.to_string();
            serde_json::to_string(&Refused { error }).expect("a text can be written as JSON")
        })
    }

    /// Sets what the surrounding program provides. If that includes a connected sensor, the program
    /// hands over its frames from now on.
    pub fn set_offer(&mut self, offer: Offer, provenance: &str) {
        self.desk = offer.source.as_ref().map(|source| Desk::new(source, provenance));
        if let (Some(desk), Some(sensor)) = (&mut self.desk, &self.sensor) {
            desk.set_sensor(sensor);
        }
        self.offer = offer;
    }

    /// Stores a file that descriptions name.
    pub fn keep(&mut self, name: &str, bytes: &[u8]) {
        self.surrogate = None; // it may be that file
        self.files.keep(name, bytes);
    }

    /// Hands over a frame of the connected sensor: absolute pressures of its taxels, kPa, `None`
    /// for a taxel without a reading. The frame is ignored while a line that the page reads has
    /// replaced that sensor.
    pub fn take_frame(&mut self, pressures_kpa: Vec<Option<f64>>) {
        if let Some(desk) = self.offered() {
            desk.take_frame(pressures_kpa);
        }
    }

    /// Sets the remarks about the frames of the connected sensor, one sentence each.
    pub fn set_remarks(&mut self, remarks: Vec<String>) {
        if let Some(desk) = self.offered() {
            desk.set_remarks(remarks);
        }
    }

    fn offered(&mut self) -> Option<&mut Desk> {
        self.desk.as_mut().filter(|desk| !desk.has_line())
    }

    /// The arrays to draw after the last request.
    #[must_use]
    pub fn arrays(&self) -> &Arrays {
        &self.arrays
    }

    /// The arrays that changed since the last call: those to send if the page does not share the
    /// engine's memory.
    pub fn take_new(&mut self) -> impl Iterator<Item = Array> {
        self.arrays.take_new()
    }

    fn reply(&mut self, request: &str, bytes: &[u8]) -> Result<Reply, EngineError> {
        match serde_json::from_str(request)? {
            Request::Keep { name } => {
                self.keep(&name, bytes);
                Ok(Reply::Done {})
            }
            Request::Open { file, text } => {
                let sensor = Sensor::parse(&file, &text, &|path| self.files.load(path))?;
                self.press = None;
                Ok(self.has_sensor(sensor))
            }
            Request::Add { file, text } => {
                let indenter = IndenterFile::parse(&file, &text, &|path| self.files.load(path))?;
                let sensor = indenter.added_to(self.sensor()?)?;
                Ok(self.has_sensor(sensor))
            }
            Request::Outline { shape } => {
                let shape = shape.signed_distance_field(&self.sensor()?.surfaces)?;
                outline(shape.as_ref(), &mut self.arrays);
                Ok(Reply::Done {})
            }
            Request::Prepare(asked) => {
                let press = Press::new(self.sensor()?, &asked)?;
                let prepared = press.show_mesh(&mut self.arrays);
                self.press = Some(press);
                Ok(Reply::Prepared(prepared))
            }
            Request::Step {
                since_s,
                gel_from_indenter,
            } => {
                let press = self.press.as_mut().ok_or(EngineError::NoPress)?;
                let frame = press.step(since_s, &gel_from_indenter, &mut self.arrays)?;
                Ok(Reply::Frame(frame))
            }
            Request::Touch { surrogate, bodies } => {
                let press = self.press.as_ref().ok_or(EngineError::NoPress)?;
                let known = self.surrogate.take().filter(|known| known.file() == surrogate);
                let known = match known {
                    Some(known) => known,
                    None => {
                        let bytes = self.files.load(&surrogate)?;
                        Surrogate::new(&surrogate, &bytes, self.sensor()?)?
                    }
                };
                let frame = self
                    .surrogate
                    .insert(known)
                    .touch(&bodies, press, &mut self.arrays)?;
                Ok(Reply::Frame(frame))
            }
            Request::Rest {} => {
                let press = self.press.as_mut().ok_or(EngineError::NoPress)?;
                press.rest(&mut self.arrays);
                Ok(Reply::Done {})
            }
            Request::Offer {} => Ok(Reply::Offer(self.offer.clone())),
            Request::Listen { file, text } => {
                let description = Description::parse(&file, &text)?;
                self.desk = Some(Desk::on_line(&description, self.sensor()?)?);
                Ok(Reply::Line(description.serial))
            }
            Request::Hear {} => {
                let sensor = self.sensor.as_ref().ok_or(EngineError::NoSensor)?;
                let desk = self.desk.as_mut().ok_or(EngineError::NoDesk)?;
                desk.take_bytes(bytes);
                Ok(Reply::Desk(desk.show(sensor, &mut self.arrays)?))
            }
            Request::Zero {} => {
                self.desk.as_mut().ok_or(EngineError::NoDesk)?.take_zero();
                Ok(Reply::Done {})
            }
        }
    }

    fn sensor(&self) -> Result<&Arc<Sensor>, EngineError> {
        self.sensor.as_ref().ok_or(EngineError::NoSensor)
    }

    fn has_sensor(&mut self, sensor: Sensor) -> Reply {
        let reply = SensorReply::of(&sensor);
        if let Some(desk) = &mut self.desk {
            desk.set_sensor(&sensor);
        }
        self.sensor = Some(Arc::new(sensor));
        self.surrogate = None;
        Reply::Sensor(Box::new(reply))
    }
}
