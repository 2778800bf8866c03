//! The thread that writes.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use super::recorded::Recorded;
use super::shared::Shared;
use crate::writer::FLUSH_NS;
use crate::{LogError, LogWriter, Message, Sink};

pub(super) enum Command {
    Write(Message),
    Finish,
}

/// Writes until it is told to finish or an error occurs. After an error all senders are told the
/// reason.
pub(super) fn run<S: Sink>(
    writer: LogWriter<S>,
    commands: &Receiver<Command>,
    shared: &Shared,
) -> Result<Recorded, LogError> {
    write_all(writer, commands, shared).inspect_err(|error| shared.stop(&error.to_string()))
}

fn write_all<S: Sink>(
    mut writer: LogWriter<S>,
    commands: &Receiver<Command>,
    shared: &Shared,
) -> Result<Recorded, LogError> {
    let (mut messages, mut lost) = (0, 0);
    loop {
        let is_over = match commands.recv_timeout(Duration::from_nanos(FLUSH_NS)) {
            Ok(Command::Write(message)) => {
                shared.release();
                writer.write(&message)?;
                messages += 1;
                false
            }
            Ok(Command::Finish) | Err(RecvTimeoutError::Disconnected) => true,
            // No later message would flush the waiting ones.
            Err(RecvTimeoutError::Timeout) => {
                writer.flush()?;
                false
            }
        };
        let (gaps, more) = shared.take_gaps();
        lost += more;
        for gap in gaps {
            writer.write(&gap)?;
        }
        if is_over {
            writer.close()?;
            let bytes = writer.written_bytes();
            return Ok(Recorded {
                messages,
                lost,
                bytes,
            });
        }
    }
}
