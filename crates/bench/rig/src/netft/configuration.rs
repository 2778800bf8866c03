//! The sensor's configuration page: the meaning of its counts.

use std::fmt::Write;

use glam::DVec3;

use crate::units::{newton_millimetres, newtons};
use crate::{RigError, Wrench};

/// Path of the page on the sensor's web server.
pub const PAGE: &str = "/netftapi2.xml";

/// What the configuration page states about the records.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// Counts per unit of force (`cfgcpf`).
    pub counts_per_force: f64,
    /// Counts per unit of torque (`cfgcpt`).
    pub counts_per_torque: f64,
    /// Unit of force, such as `N` (`scfgfu`).
    pub force_unit: String,
    /// Unit of torque, such as `Nm` (`scfgtu`).
    pub torque_unit: String,
    /// Name of the product, if the page has it (`prodname`).
    pub product: Option<String>,
    /// Records per second, Hz, if the page has it (`comrdtrate`).
    pub rate_hz: Option<f64>,
}

impl Configuration {
    /// Reads the page; `file` names it in errors.
    ///
    /// # Errors
    /// Text that is not the page, an element that is missing, a number that cannot be read or is
    /// not above zero, an unknown unit.
    pub fn parse(file: &str, text: &str) -> Result<Self, RigError> {
        let document = roxmltree::Document::parse(text)
            .map_err(|found| RigError::file(file, format!("is not XML: {found}")))?;
        let root = document.root_element().tag_name().name();
        if root != "netFTApi" {
            return Err(RigError::file(
                file,
                format!("its root is `{root}`, expected `netFTApi`"),
            ));
        }
        let find = |name: &str| {
            document
                .descendants()
                .find(|node| node.has_tag_name(name))
                .and_then(|node| node.text())
                .map(str::trim)
        };
        let element =
            |name: &str| find(name).ok_or_else(|| RigError::file(file, format!("has no element `{name}`")));
        let number = |name: &str| {
            let text = element(name)?;
            text.parse()
                .ok()
                .filter(|number: &f64| number.is_finite() && *number > 0.0)
                .ok_or_else(|| {
                    RigError::file(
                        file,
                        format!("`{name}` is `{text}`, expected a number above zero"),
                    )
                })
        };
        let configuration = Self {
            counts_per_force: number("cfgcpf")?,
            counts_per_torque: number("cfgcpt")?,
            force_unit: element("scfgfu")?.to_owned(),
            torque_unit: element("scfgtu")?.to_owned(),
            product: find("prodname").map(str::to_owned),
            rate_hz: find("comrdtrate").map(|_| number("comrdtrate")).transpose()?,
        };
        for (name, unit, known) in [
            (
                "scfgfu",
                &configuration.force_unit,
                newtons(&configuration.force_unit),
            ),
            (
                "scfgtu",
                &configuration.torque_unit,
                newton_millimetres(&configuration.torque_unit),
            ),
        ] {
            if known.is_none() {
                return Err(RigError::file(
                    file,
                    format!("`{name}` is `{unit}`, which is not a known unit"),
                ));
            }
        }
        Ok(configuration)
    }

    /// The XML page with this configuration.
    #[must_use]
    pub fn to_xml(&self) -> String {
        let rate = self.rate_hz.map(|rate_hz| rate_hz.to_string());
        let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<netFTApi>\n");
        for (name, value) in [
            ("prodname", self.product.clone()),
            ("cfgcpf", Some(self.counts_per_force.to_string())),
            ("cfgcpt", Some(self.counts_per_torque.to_string())),
            ("scfgfu", Some(self.force_unit.clone())),
            ("scfgtu", Some(self.torque_unit.clone())),
            ("comrdtrate", rate),
        ] {
            if let Some(value) = value {
                let value = value.replace('&', "&amp;").replace('<', "&lt;");
                let _ = writeln!(text, "<{name}>{value}</{name}>"); // writing to a String cannot fail
            }
        }
        text + "</netFTApi>\n"
    }

    /// The wrench of a record's counts.
    #[must_use]
    pub fn wrench(&self, counts: [i32; 6]) -> Wrench {
        let [fx, fy, fz, tx, ty, tz] = counts.map(f64::from);
        Wrench {
            force_n: DVec3::new(fx, fy, fz) * self.newtons_per_count(),
            torque_n_mm: DVec3::new(tx, ty, tz) * self.newton_millimetres_per_count(),
        }
    }

    /// The counts of a wrench, rounded and clamped to the range of 32 bits.
    #[must_use]
    pub fn counts(&self, wrench: &Wrench) -> [i32; 6] {
        let force = wrench.force_n / self.newtons_per_count();
        let torque = wrench.torque_n_mm / self.newton_millimetres_per_count();
        // A cast from a float clamps to the range of the integer.
        [force.x, force.y, force.z, torque.x, torque.y, torque.z].map(|count| count.round() as i32)
    }

    // `parse` checks the units. A configuration that was made by hand with an unknown unit gives
    // NaN.
    fn newtons_per_count(&self) -> f64 {
        newtons(&self.force_unit).unwrap_or(f64::NAN) / self.counts_per_force
    }

    fn newton_millimetres_per_count(&self) -> f64 {
        newton_millimetres(&self.torque_unit).unwrap_or(f64::NAN) / self.counts_per_torque
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "<?xml version=\"1.0\"?><netFTApi><prodname>Net F/T</prodname><cfgcpf>1000000</cfgcpf>\
        <cfgcpt>500000</cfgcpt><scfgfu>N</scfgfu><scfgtu>Nm</scfgtu><comrdtrate>7000</comrdtrate></netFTApi>";

    #[test]
    fn counts_become_newtons_and_newton_millimetres() {
        let configuration = Configuration::parse("page", TEXT).unwrap();
        let wrench = configuration.wrench([1_000_000, 0, -2_500_000, 500_000, 0, -1]);
        assert_eq!(wrench.force_n, DVec3::new(1.0, 0.0, -2.5));
        assert!(wrench.torque_n_mm.distance(DVec3::new(1000.0, 0.0, -0.002)) < 1e-12);
        assert_eq!(
            configuration.counts(&wrench),
            [1_000_000, 0, -2_500_000, 500_000, 0, -1]
        );
        assert_eq!(configuration.rate_hz, Some(7000.0));
        assert_eq!(
            Configuration::parse("page", &configuration.to_xml()).unwrap(),
            configuration
        );
    }

    #[test]
    fn what_is_missing_is_named() {
        for (from, to, words) in [
            ("<cfgcpf>1000000</cfgcpf>", "", "page: has no element `cfgcpf`"),
            (
                "<cfgcpt>500000</cfgcpt>",
                "<cfgcpt/>",
                "page: has no element `cfgcpt`",
            ),
            ("<scfgfu>N</scfgfu>", "", "page: has no element `scfgfu`"),
            ("<scfgtu>Nm</scfgtu>", "", "page: has no element `scfgtu`"),
            (
                ">1000000<",
                ">0<",
                "page: `cfgcpf` is `0`, expected a number above zero",
            ),
            (
                ">Nm<",
                ">stone<",
                "page: `scfgtu` is `stone`, which is not a known unit",
            ),
            ("</netFTApi>", "", "page: is not XML"),
        ] {
            let error = Configuration::parse("page", &TEXT.replace(from, to)).unwrap_err();
            assert!(error.to_string().starts_with(words), "{error}");
        }
        let other = Configuration::parse("page", "<html/>").unwrap_err().to_string();
        assert_eq!(other, "page: its root is `html`, expected `netFTApi`");
    }
}
