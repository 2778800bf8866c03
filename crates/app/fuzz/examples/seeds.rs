//! Writes the seeds of all targets into a folder, one file each: `<folder>/<target>/<number>`.

use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let folder = PathBuf::from(
        std::env::args_os()
            .nth(1)
            .ok_or(std::io::ErrorKind::InvalidInput)?,
    );
    for target in twintac_fuzz::TARGETS {
        let seeds = folder.join(target.name);
        std::fs::create_dir_all(&seeds)?;
        for (number, seed) in (target.seeds)().into_iter().enumerate() {
            std::fs::write(seeds.join(number.to_string()), seed)?;
        }
    }
    Ok(())
}
