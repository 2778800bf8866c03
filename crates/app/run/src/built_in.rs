//! Files that this crate carries with it: what stands for a file that is not named.

use std::path::Path;

use crate::RunError;
use crate::files::read_text;

/// A file that people copy and edit, as it was when this crate was compiled.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name, for errors.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// The protocol of the demo.
pub(crate) const DEMO_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/demo.toml",
    text: include_str!("../built_in/demo.toml"),
};

/// The imperfections of the emulated bench.
pub const REALITY: BuiltIn = BuiltIn {
    name: "realities/default.toml",
    text: include_str!("../built_in/reality.toml"),
};

/// How the emulated bench presses.
pub const LAB_RIG: BuiltIn = BuiltIn {
    name: "rigs/lab.toml",
    text: include_str!("../built_in/lab.toml"),
};

impl BuiltIn {
    /// Name and text of a file, or without one of this.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn unless(self, file: Option<&Path>) -> Result<(String, String), RunError> {
        match file {
            None => Ok((self.name.to_owned(), self.text.to_owned())),
            Some(file) => Ok((file.display().to_string(), read_text(file)?)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The copies in this package are symbolic links to the files that people edit; where links are not kept, they must be equal.
    #[test]
    fn what_is_built_in_is_what_people_edit() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        for built_in in [DEMO_PROTOCOL, REALITY, LAB_RIG] {
            let edited = std::fs::read_to_string(root.join(built_in.name)).unwrap();
            assert_eq!(built_in.text, edited, "{}", built_in.name);
        }
    }
}
