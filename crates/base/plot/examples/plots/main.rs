//! Draws every kind of plot from made-up data, to look at:
//! `cargo run -p twintac-plot --example plots [folder]`.

mod plots;

use std::path::Path;

use twintac_plot::page::{Badge, Block, Figure, Page, Section};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "runs/plots".into());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    for (section, plots) in [
        ("short", plots::plots(str::to_owned)),
        ("long", plots::plots(plots::long)),
    ] {
        for (name, scene) in &plots {
            scene.write(&folder.join(format!("{section}-{name}.png")))?;
            scene.write(&folder.join(format!("{section}-{name}.svg")))?;
        }
        let figure = |(name, scene)| Figure {
            scene,
            badge: Some(Badge("simulated".into())),
            caption: format!("Labels are {section}: {name}."),
            table: None,
        };
        let figures = plots.into_iter().map(figure).collect();
        let page = Page {
            kind: "Gallery".into(),
            title: "Every kind of plot".into(),
            sections: vec![Section {
                id: "plots",
                title: "Plots",
                blocks: vec![Block::Figures(figures)],
            }],
            ..Page::default()
        };
        page.write(&folder.join(format!("{section}.html")))?;
    }
    Ok(())
}
