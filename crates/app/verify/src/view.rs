//! Many clients of `twintac view` for minutes, and its memory: `cargo xtask bench view`.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, ensure};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

use crate::files::{memory_mib, write_whole};
use crate::rung::plots;

/// Folder of the results.
const RESULTS: &str = "docs/benchmarks";
/// The description that clients press.
const SENSOR: &str = "sensors/phystac.toml";
/// Number of frames after which a client leaves and comes again.
const FRAMES_A_VISIT: usize = 300;
/// Largest number of nodes of a client's gel.
const MOST_NODES: usize = 1000;
/// Interval between two measurements of the memory.
const INTERVAL: Duration = Duration::from_secs(5);
/// How long the server may take to end.
const FAREWELL: Duration = Duration::from_secs(10);

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Number of clients
    #[arg(long, default_value_t = 10)]
    clients: u64,
    /// Duration, minutes
    #[arg(long, default_value_t = 10.0)]
    minutes: f64,
}

/// The results.
#[derive(Serialize, Deserialize)]
struct Results {
    command: String,
    provenance: String,
    clients: u64,
    minutes: f64,
    /// Connections, and frames that were pressed, of all clients.
    visits: u64,
    frames: u64,
    /// Frames that the gel could not be solved for.
    unsolved: u64,
    /// Time of a frame for its client, ms.
    frame_median_ms: f64,
    frame_99_ms: f64,
    /// Median memory of the server over the second quarter of the time, and over the last, MiB.
    early_mib: f64,
    late_mib: f64,
    /// Time that the server took to end after an interrupt, s.
    end_s: f64,
    /// Time, minutes, and memory, MiB.
    memory: Vec<[f64; 2]>,
}

/// What one client has done.
#[derive(Default)]
struct Visits {
    n: u64,
    frames_ms: Vec<f64>,
    unsolved: u64,
}

pub(crate) fn run(options: &Options) -> Result<()> {
    let sensor = std::fs::read_to_string(SENSOR).context("run this where the folder `sensors` is")?;
    let page = tempfile::NamedTempFile::new()?;
    write_whole(page.path(), b"<!doctype html>")?;
    let mut server = serve(page.path())?;
    let url = match url(&mut server) {
        Ok(url) => url,
        Err(error) => {
            server.kill()?;
            return Err(error);
        }
    };
    let (sensor, is_over) = (sensor.as_str(), &AtomicBool::new(false));
    let started = Instant::now();
    let (visits, memory) = thread::scope(|scope| {
        let clients: Vec<_> = (0..options.clients)
            .map(|client| {
                let url = &url;
                scope.spawn(move || visit(url, sensor, client, is_over))
            })
            .collect();
        let memory = watch(&server, options, started);
        is_over.store(true, Ordering::Relaxed);
        let visits = clients.into_iter().map(|client| client.join());
        let visits: Result<Vec<Visits>> = visits
            .map(|visits| visits.map_err(|_| anyhow!("a client died"))?)
            .collect();
        (visits, memory)
    });
    let end_s = end(&mut server)?;
    let (visits, memory) = (visits?, memory?);
    let mut frames_ms: Vec<f64> = visits
        .iter()
        .flat_map(|client| client.frames_ms.clone())
        .collect();
    frames_ms.sort_by(f64::total_cmp);
    ensure!(
        frames_ms.len() > 100 && memory.len() >= 8,
        "the time is too short to tell"
    );
    let part = |from: f64, to: f64| {
        let within = |at: usize| (from..to).contains(&(at as f64 / memory.len() as f64));
        let samples = memory.iter().enumerate().filter(|(at, _)| within(*at));
        let mut mib: Vec<f64> = samples.map(|(_, [_, mib])| *mib).collect();
        mib.sort_by(f64::total_cmp);
        mib[mib.len() / 2]
    };
    let results = Results {
        command: format!(
            "cargo xtask bench view --clients {} --minutes {}",
            options.clients, options.minutes
        ),
        provenance: "simulated".to_owned(),
        clients: options.clients,
        minutes: options.minutes,
        visits: visits.iter().map(|client| client.n).sum(),
        frames: frames_ms.len() as u64,
        unsolved: visits.iter().map(|client| client.unsolved).sum(),
        frame_median_ms: frames_ms[frames_ms.len() / 2],
        frame_99_ms: frames_ms[frames_ms.len() * 99 / 100],
        early_mib: part(0.25, 0.5),
        late_mib: part(0.75, 1.0),
        end_s,
        memory,
    };
    let folder = Path::new(RESULTS);
    let text = serde_json::to_string_pretty(&results)? + "\n";
    write_whole(&folder.join("view.json"), text.as_bytes())?;
    write_whole(&folder.join("view.png"), &plot(&results)?)?;
    write_whole(&folder.join("view.md"), describe(&results).as_bytes())?;
    eprintln!("wrote {RESULTS}/view.md, view.json and view.png");
    Ok(())
}

/// Starts the server as its users do.
fn serve(page: &Path) -> Result<Child> {
    let program = std::env::current_exe()?.with_file_name("twintac");
    ensure!(
        program.exists(),
        "{} is missing: `cargo build --release -p twintac-cli`",
        program.display()
    );
    Command::new(&program)
        .args(["view", "--json", "--page"])
        .arg(page)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .context("starting twintac")
}

/// The address that the server prints.
fn url(server: &mut Child) -> Result<String> {
    let mut line = String::new();
    let said = server.stdout.as_mut().context("a server without an output")?;
    BufReader::new(said).read_line(&mut line)?;
    let said: Value = serde_json::from_str(&line).context("the server prints no address")?;
    Ok(said["url"].as_str().context("url")?.to_owned())
}

/// Measures the server's memory until the time is over.
fn watch(server: &Child, options: &Options, started: Instant) -> Result<Vec<[f64; 2]>> {
    let mut memory = Vec::new();
    let minutes = || started.elapsed().as_secs_f64() / 60.0;
    while minutes() < options.minutes {
        thread::sleep(INTERVAL);
        memory.push([minutes(), memory_mib(server.id())?]);
        if memory.len().is_multiple_of(12) {
            let [minutes, mib] = memory[memory.len() - 1];
            eprintln!("{minutes:.0} of {} min: {mib:.0} MiB", options.minutes);
        }
    }
    Ok(memory)
}

/// One client: it connects, presses its gel here and there, leaves (every second time without a
/// word), and comes again.
fn visit(url: &str, sensor: &str, client: u64, is_over: &AtomicBool) -> Result<Visits> {
    let mut random = ChaCha8Rng::seed_from_u64(client);
    let mut visits = Visits::default();
    while !is_over.load(Ordering::Relaxed) {
        let mut socket = connect(url)?;
        visits.n += 1;
        ask(
            &mut socket,
            &json!({"do": "open", "file": "phystac.toml", "text": sensor}),
        )?;
        let prepare =
            json!({"do": "prepare", "indenter": "sphere-25", "depth_mm": 2.0, "max_nodes": MOST_NODES});
        let prepared = ask(&mut socket, &prepare)?;
        let touch_mm = prepared["touch_mm"].as_f64().context("touch_mm")?;
        let mut at_mm = [0.0, 0.0, -0.5];
        for _ in 0..FRAMES_A_VISIT {
            if is_over.load(Ordering::Relaxed) {
                break;
            }
            for (place_mm, range_mm) in at_mm.iter_mut().zip([-8.0..8.0, -3.0..3.0, -2.0..0.5]) {
                let next_mm: f64 = *place_mm + random.random_range(-0.1..0.1);
                *place_mm = next_mm.clamp(range_mm.start, range_mm.end);
            }
            let [x_mm, y_mm, z_mm] = at_mm;
            let pose =
                json!({"position_mm": [x_mm, y_mm, touch_mm + z_mm], "rotation": [0.0, 0.0, 0.0, 1.0]});
            let began = Instant::now();
            let frame = ask(
                &mut socket,
                &json!({"do": "step", "since_s": 0.02, "gel_from_indenter": pose}),
            )?;
            visits.frames_ms.push(1e3 * began.elapsed().as_secs_f64());
            visits.unsolved += u64::from(!frame["error"].is_null());
        }
        if visits.n.is_multiple_of(2) {
            socket.close(None)?;
        }
    }
    Ok(visits)
}

fn connect(url: &str) -> Result<WebSocket<TcpStream>> {
    let host = url
        .strip_prefix("http://")
        .and_then(|rest| rest.split('/').next());
    let host = host.context("an address of another kind")?;
    let stream = TcpStream::connect(host)?;
    stream.set_nodelay(true)?;
    let address = url.replace("http://", "ws://").replace("/?", "/engine?");
    let (socket, _) = tungstenite::client(address, stream).map_err(|error| anyhow!("{error}"))?;
    Ok(socket)
}

/// The answer to a request; the arrays after its text are left out.
fn ask(socket: &mut WebSocket<TcpStream>, request: &Value) -> Result<Value> {
    let text = request.to_string();
    let mut message = (text.len() as u32).to_le_bytes().to_vec();
    message.extend(text.as_bytes());
    socket.send(Message::binary(message))?;
    let answer = socket.read()?.into_data();
    let (length, rest) = answer.split_first_chunk::<4>().context("an empty answer")?;
    let text = rest.get(..u32::from_le_bytes(*length) as usize);
    Ok(serde_json::from_slice(
        text.context("an answer that is cut off")?,
    )?)
}

/// Interrupts the server as Ctrl-C does; returns how long it takes to end, s.
fn end(server: &mut Child) -> Result<f64> {
    let began = Instant::now();
    let interrupted = Command::new("kill")
        .args(["-INT", &server.id().to_string()])
        .status()?;
    ensure!(interrupted.success(), "the server cannot be interrupted");
    while server.try_wait()?.is_none() {
        if began.elapsed() > FAREWELL {
            server.kill()?;
            anyhow::bail!("the server does not end when it is interrupted");
        }
        thread::sleep(Duration::from_millis(10));
    }
    Ok(began.elapsed().as_secs_f64())
}

fn plot(results: &Results) -> Result<Vec<u8>> {
    let series = vec![plots::line("server", 0, results.memory.clone())];
    let labels = ["time, min", "memory, MiB"];
    let title = format!("Memory of twintac view with {} clients", results.clients);
    Ok(twintac_plot::png(
        &plots::lines(&title, labels, false, series),
        2.0,
    )?)
}

fn describe(results: &Results) -> String {
    let rows = [
        ("connections", results.visits.to_string()),
        ("frames", results.frames.to_string()),
        ("frames without a solution", results.unsolved.to_string()),
        (
            "time of a frame for its client, median",
            format!("{:.1} ms", results.frame_median_ms),
        ),
        ("99th percentile", format!("{:.1} ms", results.frame_99_ms)),
        (
            "memory in the second quarter of the time, median",
            format!("{:.0} MiB", results.early_mib),
        ),
        (
            "memory in the last quarter, median",
            format!("{:.0} MiB", results.late_mib),
        ),
        ("time to end after Ctrl-C", format!("{:.2} s", results.end_s)),
    ];
    let rows: String = rows
        .iter()
        .map(|(what, value)| format!("| {what} | {value} |\n"))
        .collect();
    format!(
        "# Many clients of the page\n\nWritten by `{}`: {} clients of one `twintac view` for {} minutes. \
         Each presses a gel of at most {MOST_NODES} nodes as fast as it is answered, leaves after \
         {FRAMES_A_VISIT} frames, every second time without closing the connection, and comes again. \
         Simulated.\n\n| | |\n|---|---|\n{rows}\n![Memory of the server over time](view.png)\n",
        results.command, results.clients, results.minutes
    )
}
