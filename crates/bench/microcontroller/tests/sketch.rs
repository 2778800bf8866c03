//! The Arduino sketch, compiled for this computer. Its bus is a pipe with the chips at the other
//! end.
//!
//! The tests need a C++ compiler: the one that the variable `CXX` names, or `c++`. If the variable
//! is not set and there is none, the tests report this and pass without a check.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // a test that does not run says so

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use phystac::{Chip, PhysTac, Transfer, Wired, Wiring};
use twintac_emulate::i2c::{Board, BoardSettings};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault, Workcell};
use twintac_line::{Decoder, Description, Heard, LineFrame};
use twintac_microcontroller::Setup;
use twintac_rig::TcpPose;

const N: usize = 8;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../firmware")
}

/// The sketch as a program in a folder. `None` without a compiler.
fn compiled(folder_of: &tempfile::TempDir) -> Option<PathBuf> {
    let asked = std::env::var("CXX");
    let compiler = asked.clone().unwrap_or_else(|_| "c++".to_owned());
    if !Command::new(&compiler)
        .arg("--version")
        .output()
        .is_ok_and(|output| output.status.success())
    {
        assert!(asked.is_err(), "{compiler} does not run");
        eprintln!("not run: there is no {compiler}");
        return None;
    }
    let program = folder_of.path().join("sketch");
    let mock = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/arduino");
    let sketch = folder()
        .join("arduino/twintac_csv/twintac_csv.ino")
        .canonicalize()
        .unwrap();
    let output = Command::new(&compiler)
        .args([
            "-std=c++17",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-Wno-unused-value",
            "-fsanitize=undefined",
        ])
        .arg("-fno-sanitize-recover")
        .arg(format!("-DSKETCH=\"{}\"", sketch.display()))
        .arg("-I")
        .arg(&mock)
        .arg(mock.join("main.cpp"))
        .arg("-o")
        .arg(&program)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(program)
}

/// The other end of the sketch's pipe: a bus, a clock and the reset line.
struct World<B> {
    bus: B,
    clock: LabClock,
    reset: Box<dyn FnMut()>,
}

/// Runs the sketch until it has written `n` lines.
fn lines<B: I2c>(program: &Path, world: &mut World<B>, n: usize) -> Vec<String> {
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut answers = child.stdin.take().unwrap();
    let mut asked = BufReader::new(child.stdout.take().unwrap()).lines();
    let mut lines = Vec::new();
    while lines.len() < n {
        let question = asked
            .next()
            .unwrap_or_else(|| panic!("the sketch ended: {:?}", ended(&mut child)))
            .unwrap();
        if let Some(line) = question.strip_prefix("line ") {
            lines.push(line.to_owned());
        } else {
            writeln!(answers, "{}", answer(&question, world)).unwrap();
        }
    }
    child.kill().unwrap();
    child.wait().unwrap();
    lines
}

fn ended(child: &mut Child) -> std::process::ExitStatus {
    child.wait().unwrap()
}

fn answer<B: I2c>(question: &str, world: &mut World<B>) -> String {
    let mut words = question.split_whitespace();
    let what = words.next().unwrap();
    let numbers: Vec<u32> = words.map(|word| word.parse().unwrap()).collect();
    let bytes =
        |numbers: &[u32]| -> Vec<u8> { numbers.iter().map(|byte| u8::try_from(*byte).unwrap()).collect() };
    match what {
        "delay" => world.clock.delay_us(numbers[0]),
        "micros" => return (world.clock.now_us() as u32).to_string(),
        "low" => (world.reset)(),
        "clock" => assert_eq!(numbers, [400_000]),
        "write" => {
            let written = world.bus.write(numbers[0] as u8, &bytes(&numbers[1..]));
            return if written.is_ok() { "0" } else { "2" }.to_owned();
        }
        "read" => {
            let mut read = vec![0; numbers[1] as usize];
            return match world.bus.read(numbers[0] as u8, &mut read) {
                Ok(()) => read.iter().map(|byte| format!("{byte} ")).collect(),
                Err(_) => String::new(),
            };
        }
        _ => assert!(["high", "baud", "sent"].contains(&what), "{question}"),
    }
    "0".to_owned()
}

/// The frames that the host decodes from the lines.
fn frames(lines: &[String]) -> Vec<LineFrame> {
    let mut decoder = Decoder::new(&Description::read(folder().join("lines/csv-8.toml")).unwrap(), N);
    let mut frames = Vec::new();
    for line in lines {
        decoder.push(format!("{line}\r\n").as_bytes(), &mut |heard| match heard {
            Heard::Frame(frame) => frames.push(frame),
            Heard::Passed(passed) => panic!("{passed:?}: {line}"),
        });
    }
    assert_eq!(
        (decoder.tally().frames, decoder.tally().lost),
        (lines.len() as u64, 0)
    );
    frames
}

/// The switch, and behind each channel a chip that always gives the same counts.
#[derive(Clone)]
struct Table {
    mask: u8,
    command: u8,
    prom: [u16; 7],
    pressure: u32,
    temperature: u32,
    converted: u8,
}

impl ErrorType for Table {
    type Error = ErrorKind;
}

impl I2c for Table {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        if address != 0x70 && (address != 0x76 || self.mask == 0) {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        for operation in operations {
            match (address, operation) {
                (0x70, Operation::Write(bytes)) => self.mask = bytes[0],
                (0x70, Operation::Read(read)) => read.fill(self.mask),
                (_, Operation::Write(bytes)) => {
                    self.command = bytes[0];
                    if (0x40..0x60).contains(&bytes[0]) {
                        self.converted = bytes[0];
                    }
                }
                (_, Operation::Read(read)) => {
                    let counts = if self.converted < 0x50 {
                        self.pressure
                    } else {
                        self.temperature
                    };
                    let word = self.prom[usize::from(self.command.saturating_sub(0xA0) / 2).min(6)];
                    match read.len() {
                        3 => read.copy_from_slice(&counts.to_be_bytes()[1..]),
                        n => read.copy_from_slice(&word.to_be_bytes()[..n]),
                    }
                }
            }
        }
        Ok(())
    }
}

#[test]
fn the_sketch_reads_what_the_driver_reads_for_the_data_sheets_vectors() {
    let scratch = tempfile::tempdir().unwrap();
    let Some(program) = compiled(&scratch) else { return };
    // The data sheet's example, counts for cold, for frost and for heat, and for a pressure below
    // zero.
    let mut n_out = 0;
    for (pressure, temperature) in [
        (4_958_179, 6_815_414),
        (4_958_179, 6_500_000),
        (5_000_000, 5_600_000),
        (4_400_000, 7_900_000),
        (4_000_001, 6_821_377),
    ] {
        let table = Table {
            mask: 0,
            command: 0,
            prom: [0x9340, 34_982, 36_352, 20_328, 22_354, 26_646, 26_146],
            pressure,
            temperature,
            converted: 0,
        };
        let wired: [Wired; N] =
            std::array::from_fn(|channel| Wired::on_channel(Chip::Ms5837_30Ba, channel as u8));
        let clock = LabClock::virtual_time();
        let now = clock.clone();
        let settings = phystac::Settings::<N>::new(Wiring::new(&wired).unwrap());
        let mut driver = PhysTac::new(table.clone(), clock.clone(), move || now.now_us(), settings);
        let samples = driver.frame().unwrap().taxels.map(Result::unwrap);
        let mut world = World {
            bus: table,
            clock,
            reset: Box::new(|| panic!("nothing hangs")),
        };
        let frames = frames(&lines(&program, &mut world, 3));
        for (taxel, sample) in samples.iter().enumerate() {
            let Ok(driver_pa) = sample.pressure_pa(&Transfer::per_pa(1)).map(f64::from) else {
                assert_eq!(frames[2].pressures_kpa[taxel], None);
                assert_eq!(
                    frames[2].faults[taxel],
                    Some(6),
                    "out of range, as the driver says"
                );
                n_out += 1;
                continue;
            };
            let sketch_pa = 1000.0 * frames[2].pressures_kpa[taxel].unwrap();
            assert!(
                (driver_pa - sketch_pa).abs() < 0.02,
                "{pressure} {temperature}: {driver_pa} {sketch_pa} Pa"
            );
            let sketch_c = frames[2].temperatures_c[taxel].unwrap();
            assert!(
                (f64::from(sample.temperature_c) - sketch_c).abs() < 1e-4,
                "{sketch_c} °C"
            );
        }
        if temperature == 6_815_414 {
            let kpa = frames[2].pressures_kpa[0].unwrap();
            assert!(
                (kpa - 399.98).abs() < 0.01,
                "{kpa}: the data sheet has 3999.8 mbar"
            );
            assert_eq!(frames[2].temperatures_c[0], Some(19.81));
        }
    }
    assert_eq!(n_out, N, "of one pair of counts");
}

#[test]
fn the_sketch_marks_a_chip_that_goes_away_and_takes_it_up_again() {
    let scratch = tempfile::tempdir().unwrap();
    let Some(program) = compiled(&scratch) else { return };
    let clock = LabClock::virtual_time();
    let tool = TcpPose {
        position_mm: [200.0, 0.0, 99.0].into(),
        roll_pitch_yaw_rad: [std::f64::consts::PI, 0.0, 0.0].into(),
    };
    let workcell = Workcell::new(clock.clone(), Hertz::default(), tool, ArmSettings::default());
    let felt_kpa = workcell.now().sensed.taxel_pressures_kpa;
    let settings = BoardSettings {
        noise_pa: Some(0.0),
        ..Setup::of(Chip::Ms5837_30Ba).board
    };
    let faults = [
        (FaultKind::NoAcknowledge { channel: Some(2) }, 1.0),
        (FaultKind::NoAcknowledge { channel: None }, 3.0),
    ];
    let faults = faults.map(|(what, begins_s)| ScheduledFault {
        what,
        begins: Moment::TimeS(begins_s),
        lasts: Some(Moment::TimeS(0.5)),
    });
    let board = Board::new(workcell, &settings, &faults).unwrap();
    let mut reset_line = board.reset_line();
    let mut world = World {
        bus: board.bus(),
        clock,
        reset: Box::new(move || reset_line.set_low().unwrap()),
    };
    let frames = frames(&lines(&program, &mut world, 700));
    let steps_s = frames.last().unwrap().time_s.unwrap() - frames[1].time_s.unwrap();
    println!("{:.1} Hz", (frames.len() - 2) as f64 / steps_s);
    let (mut n_away, mut n_switchless) = (0, 0);
    for frame in &frames {
        let time_s = frame.time_s.unwrap();
        let is_switchless = (2.98..3.75).contains(&time_s);
        for (taxel, pressure_kpa) in frame.pressures_kpa.iter().enumerate() {
            assert_eq!(pressure_kpa.is_some(), frame.faults[taxel] == Some(0));
            match pressure_kpa {
                Some(kpa) => assert!(
                    (kpa - felt_kpa[taxel]).abs() < 0.01,
                    "{taxel}: {kpa} kPa, {}",
                    felt_kpa[taxel]
                ),
                None if is_switchless => n_switchless += 1,
                None => {
                    assert!(
                        taxel == 2 && (0.98..1.75).contains(&time_s),
                        "taxel {taxel} at {time_s} s"
                    );
                    n_away += 1;
                }
            }
        }
    }
    assert!(n_away > 40 && n_switchless > 8 * 40, "{n_away} {n_switchless}");
}
