//! Names of topics.

use std::collections::BTreeSet;

use crate::LogError;

/// Placeholder for the name of a taxel.
const TAXEL: &str = "{taxel}";

/// Names of the topics of an exported bag. Names of topics of taxels contain `{taxel}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicNames {
    pub(super) tactile: String,
    pub(super) pressure: String,
    pub(super) temperature: String,
    pub(super) wrench: String,
    pub(super) pose: String,
    pub(super) events: String,
}

impl Default for TopicNames {
    /// `/tactile`, `/tactile/{taxel}/pressure`, `/tactile/{taxel}/temperature`, `/wrench`,
    /// `/robot/pose`, `/events`.
    fn default() -> Self {
        Self {
            tactile: "/tactile".to_owned(),
            pressure: format!("/tactile/{TAXEL}/pressure"),
            temperature: format!("/tactile/{TAXEL}/temperature"),
            wrench: "/wrench".to_owned(),
            pose: "/robot/pose".to_owned(),
            events: "/events".to_owned(),
        }
    }
}

impl TopicNames {
    /// Renames a topic. `topic` is its content: `tactile`, `pressure`, `temperature`, `wrench`,
    /// `pose` or `events`.
    ///
    /// # Errors
    /// [`LogError::Invalid`]: there is no such topic, or its name is not allowed in ROS.
    pub fn rename(&mut self, topic: &str, name: &str) -> Result<(), LogError> {
        let invalid = |problem: String| LogError::Invalid {
            what: "topic",
            problem,
        };
        let (old, is_of_taxels) = match topic {
            "tactile" => (&mut self.tactile, false),
            "pressure" => (&mut self.pressure, true),
            "temperature" => (&mut self.temperature, true),
            "wrench" => (&mut self.wrench, false),
            "pose" => (&mut self.pose, false),
            "events" => (&mut self.events, false),
            _ => {
                let known = "tactile, pressure, temperature, wrench, pose, events";
                return Err(invalid(format!("`{topic}` is unknown; there are {known}")));
            }
        };
        if name.contains(TAXEL) != is_of_taxels {
            let has = if is_of_taxels { "needs" } else { "has no" };
            return Err(invalid(format!("`{name}`: {topic} {has} `{TAXEL}`")));
        }
        if !is_taken_by_ros(&name.replace(TAXEL, "taxel")) {
            return Err(invalid(format!(
                "`{name}` is not a name of a topic: expected parts of letters, digits and underscores, each after a `/` and not beginning with a digit"
            )));
        }
        name.clone_into(old);
        Ok(())
    }

    /// Checks that no two topics have the same name.
    pub(crate) fn check(&self) -> Result<(), LogError> {
        let all = [
            &self.tactile,
            &self.pressure,
            &self.temperature,
            &self.wrench,
            &self.pose,
            &self.events,
        ];
        let mut taken = BTreeSet::new();
        match all.into_iter().find(|name| !taken.insert(*name)) {
            None => Ok(()),
            Some(name) => Err(LogError::Invalid {
                what: "topic",
                problem: format!("two are called `{name}`"),
            }),
        }
    }

    pub(super) fn pressure_of(&self, taxel: &str) -> String {
        self.pressure.replace(TAXEL, taxel)
    }

    pub(super) fn temperature_of(&self, taxel: &str) -> String {
        self.temperature.replace(TAXEL, taxel)
    }
}

fn is_taken_by_ros(name: &str) -> bool {
    let is_part = |part: &str| {
        let mut letters = part.chars();
        letters
            .next()
            .is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
            && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    name.strip_prefix('/')
        .is_some_and(|rest| rest.split('/').all(is_part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_ros_takes() {
        let mut names = TopicNames::default();
        names.rename("tactile", "/finger_1/touch").unwrap();
        names.rename("pressure", "/finger_1/{taxel}").unwrap();
        assert_eq!(names.pressure_of("t3"), "/finger_1/t3");
        for (topic, name, why) in [
            ("touch", "/touch", "`touch` is unknown"),
            ("wrench", "wrench", "`wrench` is not a name"),
            ("wrench", "/a//b", "is not a name"),
            ("wrench", "/1st", "is not a name"),
            ("wrench", "/", "is not a name"),
            ("wrench", "/{taxel}", "has no"),
            ("pressure", "/pressure", "needs"),
        ] {
            let problem = names.rename(topic, name).unwrap_err().to_string();
            assert!(problem.contains(why), "{problem}");
        }
        names.rename("pose", "/wrench").unwrap();
        assert!(names.check().unwrap_err().to_string().contains("`/wrench`"));
    }
}
