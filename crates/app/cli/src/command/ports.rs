//! `twintac ports`: lists ports, and describes what arrives there.

use std::time::Duration;

use anyhow::Result;
use serde::Serialize;
use twintac_source::{Port, Sound, listen, ports};

use crate::arguments::Ports;
use crate::output::print;
use crate::progress::say;

/// A port, for JSON.
#[derive(Serialize)]
struct Heard {
    path: String,
    what: String,
    is_serial: bool,
    bytes_per_s: Option<f64>,
    lines_per_s: Option<f64>,
    numbers: Option<usize>,
    between: Option<&'static str>,
    example: Option<String>,
}

pub(super) fn run(arguments: &Ports) -> Result<()> {
    let mut heard = Vec::new();
    for port in ports() {
        let sound = match arguments.listen {
            Some(seconds) if port.is_serial => {
                say(&format!("listening to {} for {seconds} s", port.path));
                match listen(&port.path, arguments.baud, Duration::from_secs_f64(seconds)) {
                    Ok(sound) => Some(sound),
                    Err(error) => {
                        say(&error.to_string());
                        None
                    }
                }
            }
            _ => None,
        };
        heard.push((port, sound));
    }
    if arguments.json {
        let list: Vec<Heard> = heard
            .into_iter()
            .map(|(port, sound)| in_json(port, sound))
            .collect();
        return print(&serde_json::to_string_pretty(&list)?);
    }
    if heard.is_empty() {
        say("there is no serial port and no I2C bus on this computer");
    }
    for (port, sound) in &heard {
        print(&format!("{:<20} {}", port.path, port.what))?;
        if let Some(sound) = sound {
            print(&format!("{:<20} {}", "", in_words(sound)))?;
        }
    }
    Ok(())
}

fn in_json(port: Port, sound: Option<Sound>) -> Heard {
    let numbers = sound.as_ref().and_then(|sound| sound.numbers);
    Heard {
        path: port.path,
        what: port.what,
        is_serial: port.is_serial,
        bytes_per_s: sound.as_ref().map(|sound| sound.bytes_per_s),
        lines_per_s: sound.as_ref().map(|sound| sound.lines_per_s),
        numbers: numbers.map(|(n, _)| n),
        between: numbers.map(|(_, between)| between),
        example: sound.and_then(|sound| sound.example),
    }
}

fn in_words(sound: &Sound) -> String {
    let Sound {
        bytes_per_s,
        lines_per_s,
        numbers,
        example,
    } = sound;
    if *bytes_per_s == 0.0 {
        return "is silent".to_owned();
    }
    let example = example
        .as_deref()
        .map_or(String::new(), |line| format!(", such as `{}`", line));
    match numbers {
        Some((n, between)) => {
            format!("{lines_per_s:.0} lines a second of {n} numbers between {between}{example}")
        }
        None if *lines_per_s > 0.0 => format!("{lines_per_s:.0} lines a second of text{example}"),
        None => format!(
            "{bytes_per_s:.0} bytes a second that are not text: another rate of bits (`--baud`), or packets"
        ),
    }
}
