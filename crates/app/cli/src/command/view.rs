//! `twintac view`: serves the page of the gel, and solves it.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use serde_json::json;
use twintac_live::Live;
use twintac_view::{Begin, Desk, GelSession, PAGE, Server, View};

use super::files::sensor_or_phystac;
use crate::arguments::View as Arguments;
use crate::output::print;
use crate::progress::say;

/// The file that `cargo xtask web` writes.
const MADE: &str = "target/web/twintac.html";

static ENDED: AtomicBool = AtomicBool::new(false);

/// Longest wait for a frame before the end of the program is checked.
const PATIENCE: Duration = Duration::from_millis(100);

/// Serves the page until a signal.
pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let sensor = sensor_or_phystac(arguments.sensor.as_deref())?;
    let begin = arguments.sensor.as_deref().map(|file| Begin {
        file: file
            .file_name()
            .unwrap_or(file.as_os_str())
            .to_string_lossy()
            .into_owned(),
        text: sensor.text.clone(),
        surfaces: sensor.surfaces().clone(),
    });
    let page = page(arguments.page.as_deref())?;
    let live = arguments
        .wire
        .origin()
        .map(|origin| Live::open(&origin, &sensor.sensor, &sensor.text, &arguments.wire.known()))
        .transpose()?;
    let desk = live.as_ref().map(|live| {
        let (source, provenance) = (arguments.wire.to_string(), live.about.provenance.to_string());
        Arc::new(Desk::new(&source, &provenance))
    });
    let its_desk = desk.clone();
    let view = View {
        page,
        session: Box::new(move || Box::new(GelSession::beside(its_desk.clone(), begin.as_ref()))),
    };
    let server = Server::bind(arguments.listen)?;
    ctrlc::set_handler(|| ENDED.store(true, Ordering::Relaxed)).context("listening to signals")?;
    if arguments.json {
        print(&json!({ "url": server.url() }).to_string())?;
    } else {
        print(&server.url())?;
    }
    if !arguments.listen.ip().is_loopback() {
        say(
            "other computers can connect, and the connection is not encrypted: give the address only to people whom you trust",
        );
    }
    say("open the address in a browser; Ctrl-C ends it");
    std::thread::scope(|scope| {
        if let (Some(live), Some(desk)) = (live, &desk) {
            live.notes.iter().for_each(|note| say(note));
            scope.spawn(move || hand_over(live, desk));
        }
        Ok(server.serve(&view, &ENDED)?)
    })
}

/// Hands frames over as they come, until the program or the sensor ends. If the sensor ends, the
/// page continues without it and says why.
fn hand_over(mut live: Live, desk: &Desk) {
    while !ENDED.load(Ordering::Relaxed) {
        match live.source.next(PATIENCE) {
            Ok(Some(reading)) => {
                let taxels = reading.frame.taxels.iter();
                desk.push(
                    taxels
                        .map(|taxel| taxel.pressure_pa.map(|pa| 1e-3 * pa))
                        .collect(),
                );
                desk.set_remarks(live.source.tally().remarks);
            }
            Ok(None) => {}
            Err(error) => {
                let ended = format!("there are no more frames: {error}");
                say(&ended);
                desk.set_remarks(vec![ended]);
                return;
            }
        }
    }
}

/// The requested page, that of this program, or the one that was made in this folder.
fn page(asked: Option<&Path>) -> Result<Vec<u8>> {
    let path = match (asked, PAGE) {
        (Some(path), _) => path,
        (None, Some(page)) => return Ok(page.to_vec()),
        (None, None) if Path::new(MADE).exists() => Path::new(MADE),
        (None, None) => bail!(
            "this program was built without the page, and {MADE} does not exist: make it with `cargo xtask web` in a checkout, or name that of the release with --page"
        ),
    };
    let page = std::fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    if !page.trim_ascii_start().starts_with(b"<") {
        bail!(
            "{} is not an HTML page: `cargo xtask web` makes one",
            path.display()
        );
    }
    Ok(page)
}
