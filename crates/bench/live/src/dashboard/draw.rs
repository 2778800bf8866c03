//! Draws the picture of a state.

use std::collections::VecDeque;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Sparkline};
use twintac_plot::PALETTE;

use super::DashboardState;
use super::map::Map;

/// Levels of a trace: eight per line of text.
const LEVELS: f64 = 800.0;
/// Columns of the name and value of a trace.
const LABEL: u16 = 20;

/// Draws a state. The picture depends on nothing else.
pub fn draw(frame: &mut Frame<'_>, state: &DashboardState) {
    let [head, body, foot] =
        Layout::vertical([Constraint::Length(2), Constraint::Fill(1), Constraint::Length(1)])
            .areas(frame.area());
    let [left, right] = Layout::horizontal([Constraint::Fill(1); 2]).areas(body);
    header(frame, head, state);
    let title = format!(" pressure above the tare, 0 to {:.1} kPa ", state.scale_kpa());
    let block = Block::bordered().title(title);
    frame.render_widget(Map(state), block.inner(left));
    frame.render_widget(block, left);
    traces(frame, right, state);
    let keys = "t tare  r record  q quit";
    let foot_line = Line::from(vec![keys.bold(), "  ".into(), Span::raw(&state.message)]);
    frame.render_widget(foot_line, foot);
}

fn header(frame: &mut Frame<'_>, area: Rect, state: &DashboardState) {
    let about = &state.about;
    let number = |value: Option<f64>, decimals: usize| {
        value.map_or("–".to_owned(), |value| format!("{value:.decimals$}"))
    };
    let mut first = vec![
        Span::from(about.sensor.clone()).bold(),
        format!("  {}", about.provenance).into(),
        format!("  {} Hz", number(state.rate_hz(), 1)).into(),
        format!("  {} °C", number(state.temperature_c(), 1)).into(),
        format!(
            "  frame {}",
            state.latest.as_ref().map_or(0, |latest| latest.sequence)
        )
        .into(),
        count("missed", state.tally.missed),
        count("failed", state.tally.failed),
    ];
    if let Some(recording) = &state.recording {
        first.push(
            format!("  ● {} ({} frames)", recording.file, recording.frames)
                .fg(Color::Red)
                .bold(),
        );
    }
    let faults = about.taxels.iter().zip(state.faults());
    let faults: Vec<String> = faults
        .filter_map(|(taxel, fault)| Some(format!("{taxel} {}", fault?)))
        .collect();
    let mut second = match faults.is_empty() {
        true => vec!["no faults".fg(Color::Green)],
        false => vec![faults.join(", ").fg(Color::LightRed)],
    };
    if let Some(failure) = &state.tally.last_failure {
        second.push(format!("  {failure}").fg(Color::Yellow));
    }
    frame.render_widget(Line::from(first), Rect { height: 1, ..area });
    let below = Rect {
        y: area.y + 1,
        height: 1,
        ..area
    };
    frame.render_widget(Line::from(second), below);
}

fn count(what: &str, count: u64) -> Span<'static> {
    let span = Span::from(format!("  {count} {what}"));
    if count == 0 { span } else { span.fg(Color::Yellow) }
}

fn traces(frame: &mut Frame<'_>, area: Rect, state: &DashboardState) {
    let block = Block::bordered().title(" traces, kPa ");
    let inside = block.inner(area);
    frame.render_widget(block, area);
    let n = state.about.taxels.len();
    let lines = Layout::vertical(vec![Constraint::Fill(1); n]).split(inside);
    let scale_kpa = state.scale_kpa();
    let faults = state.faults();
    for (taxel, line) in lines.iter().enumerate() {
        let [label, trace] =
            Layout::horizontal([Constraint::Length(LABEL), Constraint::Fill(1)]).areas(*line);
        let [red, green, blue] = PALETTE[taxel % PALETTE.len()];
        let style = Style::new().fg(Color::Rgb(red, green, blue));
        let history = &state.traces_kpa[taxel];
        let value = match (faults[taxel], history.back().copied().flatten()) {
            (Some(fault), _) => format!("{fault:>11}").fg(Color::LightRed),
            (None, Some(above_kpa)) => format!("{above_kpa:>11.3}").into(),
            (None, None) => format!("{:>11}", "–").into(),
        };
        let name = Span::styled(format!("{:<7} ", state.about.taxels[taxel]), style);
        let line_of_text = Rect {
            height: label.height.min(1),
            ..label
        };
        frame.render_widget(Line::from(vec![name, value]), line_of_text);
        let bars = bars(history, usize::from(trace.width), scale_kpa);
        frame.render_widget(
            Sparkline::default().data(bars).max(LEVELS as u64).style(style),
            trace,
        );
    }
}

/// Resamples a trace to a number of columns: the largest pressure of each column as a level. A
/// column without a pressure is empty.
fn bars(trace_kpa: &VecDeque<Option<f64>>, columns: usize, scale_kpa: f64) -> Vec<Option<u64>> {
    let n = trace_kpa.len();
    let of_column = |column: usize| {
        let (begin, end) = (
            column * n / columns,
            ((column + 1) * n / columns).max(column * n / columns + 1),
        );
        let known = trace_kpa.range(begin..end.min(n)).flatten();
        let most_kpa = known.copied().reduce(f64::max)?;
        Some((LEVELS * (most_kpa / scale_kpa).clamp(0.0, 1.0)).round() as u64)
    };
    match n {
        0 => Vec::new(),
        _ => (0..columns).map(of_column).collect(),
    }
}
