//! The loop between source, keys and terminal.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use twintac_source::{FrameSource, Tally};

use super::{DashboardState, RecordingStatus, draw};
use crate::{About, LiveError, TouchRecording};

/// Time between two pictures: 15 a second.
const PICTURE: Duration = Duration::from_millis(66);
/// How long to wait for a frame before looking at the keys again.
const GLANCE: Duration = Duration::from_millis(10);

/// Shows frames on the terminal until `q` is pressed, the source ends or `stop` is set, for example
/// by a signal. Then it restores the terminal and finishes a recording. Recordings go into
/// `folder`.
///
/// # Errors
/// [`LiveError::Terminal`]: standard output is not a terminal, or fails. Those of
/// [`FrameSource::next`]. [`LiveError::Log`]: a recording could not be finished.
pub fn run(
    source: &mut FrameSource,
    about: About,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Tally, LiveError> {
    if !std::io::stdout().is_terminal() {
        return Err(LiveError::Terminal(std::io::Error::other(
            "standard output is not a terminal",
        )));
    }
    let state = DashboardState::new(about)?;
    let mut terminal = ratatui::try_init().map_err(LiveError::Terminal)?;
    let mut recording = None;
    let result = show(&mut terminal, source, state, folder, &mut recording, stop);
    ratatui::restore();
    if let Some(recording) = recording {
        recording.finish()?;
    }
    result.map(|()| source.tally())
}

fn show(
    terminal: &mut DefaultTerminal,
    source: &mut FrameSource,
    mut state: DashboardState,
    folder: &Path,
    recording: &mut Option<TouchRecording>,
    stop: &AtomicBool,
) -> Result<(), LiveError> {
    let mut next_picture = Instant::now();
    while !stop.load(Ordering::Relaxed) {
        let mut waiting = source.next(GLANCE)?;
        while let Some(reading) = waiting {
            if let Some(log) = recording
                && let Err(error) = log.push(&reading)
            {
                state.message = error.to_string();
            }
            state.push(reading);
            waiting = match Instant::now() < next_picture {
                true => source.next(Duration::ZERO)?,
                false => None,
            };
        }
        while event::poll(Duration::ZERO).map_err(LiveError::Terminal)? {
            let Event::Key(key) = event::read().map_err(LiveError::Terminal)? else {
                continue;
            };
            let with_control = key.modifiers.contains(KeyModifiers::CONTROL);
            match key.code {
                _ if key.kind != KeyEventKind::Press => {}
                KeyCode::Char('q') | KeyCode::Esc => return Ok(()),
                KeyCode::Char('c') if with_control => return Ok(()),
                KeyCode::Char('t') => state.tare(),
                KeyCode::Char('r') => state.message = toggle(recording, folder, &state.about),
                _ => {}
            }
        }
        if Instant::now() >= next_picture {
            state.tally = source.tally();
            state.recording = recording.as_ref().map(|log| RecordingStatus {
                file: log.path().display().to_string(),
                frames: log.frames(),
            });
            state.refresh()?;
            terminal
                .draw(|frame| draw(frame, &state))
                .map_err(LiveError::Terminal)?;
            next_picture = Instant::now() + PICTURE; // frames are taken between two pictures, however long drawing takes
        }
    }
    Ok(())
}

/// Begins or ends a recording, and returns a message. An error of a file does not end the
/// dashboard.
fn toggle(recording: &mut Option<TouchRecording>, folder: &Path, about: &About) -> String {
    let result = match recording.take() {
        Some(log) => {
            let file = log.path().display().to_string();
            log.finish().map(|frames| format!("{file} has {frames} frames"))
        }
        None => TouchRecording::begin(folder, about).map(|log| {
            let message = format!("recording {}", log.path().display());
            *recording = Some(log);
            message
        }),
    };
    result.unwrap_or_else(|error| error.to_string())
}
