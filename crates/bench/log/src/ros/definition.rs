//! Message definitions in the format of ROS, each with the definitions of its nested messages.

/// A schema of the file. Its number in the file is its index in [`DEFINITIONS`], counted from 1.
#[derive(Debug)]
pub(crate) struct Definition {
    /// Name, such as `std_msgs/msg/String`.
    pub(crate) name: &'static str,
    /// Its fields, then those of its nested messages.
    pub(crate) text: &'static str,
}

/// The encoding of `text`.
pub(crate) const SCHEMA_ENCODING: &str = "ros2msg";

macro_rules! with_parts {
    ($own:expr $(, $name:literal: $part:expr)*) => {
        concat!($own $(,
            "================================================================================\n",
            "MSG: ", $name, "\n", $part)*)
    };
}

macro_rules! header {
    () => {
        "builtin_interfaces/Time stamp\nstring frame_id\n"
    };
}
macro_rules! time {
    () => {
        "int32 sec\nuint32 nanosec\n"
    };
}
macro_rules! xyz {
    () => {
        "float64 x\nfloat64 y\nfloat64 z\n"
    };
}
macro_rules! quaternion {
    () => {
        "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
    };
}

macro_rules! with_header {
    ($own:expr $(, $name:literal: $part:expr)*) => {
        with_parts!($own $(, $name: $part)*, "std_msgs/Header": header!(), "builtin_interfaces/Time": time!())
    };
}

pub(super) const STRING: usize = 0;
pub(super) const TACTILE_FRAME: usize = 1;
pub(super) const WRENCH_SAMPLE: usize = 2;
pub(super) const POSE_SAMPLE: usize = 3;
pub(super) const WRENCH_STAMPED: usize = 4;
pub(super) const POSE_STAMPED: usize = 5;
pub(super) const FLUID_PRESSURE: usize = 6;
pub(super) const TEMPERATURE: usize = 7;
pub(super) const FLOAT32_MULTI_ARRAY: usize = 8;

/// Number of [`DEFINITIONS`], from the first on, that a log has.
pub(super) const OF_LOGS: usize = 8;

/// All schemas.
pub(crate) const DEFINITIONS: [Definition; 9] = [
    Definition {
        name: "std_msgs/msg/String",
        text: "string data\n",
    },
    Definition {
        name: "twintac_msgs/msg/TactileFrame",
        text: with_header!(
            "# One reading of all taxels, in the order that the metadata has. The header's stamp is when they were triggered.\n\
             uint8 GOOD=0\nuint8 MISSING=1\nuint8 STUCK=2\nuint8 BUS_ERROR=3\n\
             uint8 ISOLATED=4\nuint8 REFUSED=5\nuint8 SATURATED=6\nuint8 FROZEN=7\n\
             int32 NO_COUNTS=-2147483648\n\
             std_msgs/Header header\n\
             # The sensor's own clock\n\
             uint64 triggered_us\n\
             uint64[] read_us\n\
             uint8[] state\n\
             int32[] counts\n\
             # Not a number: no value\n\
             float64[] pressure_pa\n\
             float64[] temperature_c\n"
        ),
    },
    Definition {
        name: "twintac_msgs/msg/WrenchSample",
        text: with_header!(
            "# One reading of the force/torque sensor, without any tare.\n\
             std_msgs/Header header\n\
             # The sensor's own clock; not a number: it has none\n\
             float64 source_s\n\
             # -1: it does not count its readings\n\
             int64 sequence\n\
             uint32 status\n\
             uint32 lost_before\n\
             geometry_msgs/Vector3 force_n\n\
             geometry_msgs/Vector3 torque_n_mm\n",
            "geometry_msgs/Vector3": xyz!()
        ),
    },
    Definition {
        name: "twintac_msgs/msg/PoseSample",
        text: with_header!(
            "# The robot's tool in its base frame.\n\
             std_msgs/Header header\n\
             # The robot's own clock; not a number: it has none\n\
             float64 source_s\n\
             geometry_msgs/Point position_mm\n\
             geometry_msgs/Quaternion rotation\n",
            "geometry_msgs/Point": xyz!(),
            "geometry_msgs/Quaternion": quaternion!()
        ),
    },
    Definition {
        name: "geometry_msgs/msg/WrenchStamped",
        text: with_header!(
            "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n",
            "geometry_msgs/Wrench": "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n",
            "geometry_msgs/Vector3": xyz!()
        ),
    },
    Definition {
        name: "geometry_msgs/msg/PoseStamped",
        text: with_header!(
            "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
            "geometry_msgs/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
            "geometry_msgs/Point": xyz!(),
            "geometry_msgs/Quaternion": quaternion!()
        ),
    },
    Definition {
        name: "sensor_msgs/msg/FluidPressure",
        text: with_header!("std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"),
    },
    Definition {
        name: "sensor_msgs/msg/Temperature",
        text: with_header!("std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n"),
    },
    Definition {
        name: "std_msgs/msg/Float32MultiArray",
        text: with_parts!(
            "std_msgs/MultiArrayLayout layout\nfloat32[] data\n",
            "std_msgs/MultiArrayLayout": "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n",
            "std_msgs/MultiArrayDimension": "string label\nuint32 size\nuint32 stride\n"
        ),
    },
];
