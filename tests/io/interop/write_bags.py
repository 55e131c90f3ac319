"""Writes the reference drive (see reference_drive.hpp) as ROS 1 bags with Debian's python3-rosbag.

usage: write_bags.py FOLDER; makes none.bag, lz4.bag and bz2.bag, and run.bag of the drive in run.jsonl.
Exit status 77: python3-rosbag is not installed.
"""
import json
import math
import pathlib
import sys

try:
    import genpy
    import genpy.dynamic
    import rosbag
except ImportError as error:
    print(f"skipped: python3-rosbag is not installed ({error})")
    sys.exit(77)

# ROS 1's own definitions; rosbag alone does not bring the message packages with it.
DEFINITIONS = {
    "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    "geometry_msgs/Pose": "Point position\nQuaternion orientation\n",
    "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance\n",
    "geometry_msgs/Twist": "Vector3 linear\nVector3 angular\n",
    "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance\n",
    "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation\n",
    "geometry_msgs/TransformStamped": "Header header\nstring child_frame_id\nTransform transform\n",
    "geometry_msgs/PoseWithCovarianceStamped": "Header header\nPoseWithCovariance pose\n",
    "nav_msgs/Odometry": "Header header\nstring child_frame_id\n"
                         "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n",
    "sensor_msgs/LaserScan": "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
                             "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
                             "float32[] ranges\nfloat32[] intensities\n",
    "sensor_msgs/MagneticField": "Header header\ngeometry_msgs/Vector3 magnetic_field\n"
                                 "float64[9] magnetic_field_covariance\n",
    "sensor_msgs/Imu": "Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
                       "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
                       "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
}


def make_class(name):
    parts = [DEFINITIONS[name]]
    for other, text in DEFINITIONS.items():
        if other != name:
            parts.append("=" * 80 + f"\nMSG: {other}\n{text}")
    return genpy.dynamic.generate_dynamic(name, "".join(parts))[name]


CLASSES = {name: make_class(name) for name in DEFINITIONS if not name.startswith("std_msgs")}


def with_header(name, stamp, frame):
    message = CLASSES[name]()
    message.header.stamp = stamp
    message.header.frame_id = frame
    return message


def set_fields(target, **values):
    for field, value in values.items():
        setattr(target, field, value)


def transform(stamp, parent, child, offset, rotation):
    message = with_header("geometry_msgs/TransformStamped", stamp, parent)
    message.child_frame_id = child
    set_fields(message.transform.translation, x=offset[0], y=offset[1], z=offset[2])
    set_fields(message.transform.rotation, x=rotation[0], y=rotation[1], z=rotation[2], w=rotation[3])
    return message


def drive():
    """The messages as (topic, message, stamp)."""
    start = genpy.Time(1000, 0)
    tf = CLASSES["tf2_msgs/TFMessage"]()
    tf.transforms = [transform(start, "/base_link", "/deck", (0.25, 0.0, 0.5), (0.0, 0.0, 0.6, 0.8)),
                     transform(start, "deck", "laser", (0.0, 0.125, 0.0), (0.0, 0.0, 0.0, 1.0)),
                     transform(start, "imu_link", "base_link", (0.0, 0.0, -1.0), (1.0, 0.0, 0.0, 0.0))]
    yield "/tf_static", tf, start
    for i in range(200):
        stamp = genpy.Time.from_sec(1000.0 + 0.125 * i)
        odometry = with_header("nav_msgs/Odometry", stamp, "odom")
        odometry.child_frame_id = "base_link"
        set_fields(odometry.pose.pose.position, x=0.125 * i, y=-0.0625 * i)
        set_fields(odometry.pose.pose.orientation, z=0.6, w=0.8)
        yield "/odom", odometry, stamp
        field = with_header("sensor_msgs/MagneticField", stamp, "/imu_link")
        set_fields(field.magnetic_field, x=2e-5, y=1e-9 * i, z=-4e-5)
        yield "/imu/mag", field, stamp
        imu = with_header("sensor_msgs/Imu", stamp, "imu_link")
        set_fields(imu.orientation, z=0.6, w=0.8)
        set_fields(imu.angular_velocity, x=0.5, y=-0.25, z=0.125 * i)
        yield "/imu/data", imu, stamp
        pose = with_header("geometry_msgs/PoseWithCovarianceStamped", stamp, "map")
        set_fields(pose.pose.pose.position, x=10.0 + 0.125 * i, y=5.0)
        set_fields(pose.pose.pose.orientation, w=1.0)
        yield "/ground_truth", pose, stamp
        scan = with_header("sensor_msgs/LaserScan", stamp, "laser")
        set_fields(scan, angle_min=1.5, angle_max=-1.5, angle_increment=-0.125, time_increment=0.0009765625,
                   range_min=0.125, range_max=30.0, ranges=[1.0 + (i + beam) / 64.0 for beam in range(25)])
        yield "/scan", scan, stamp


def recorded(file):
    """The messages of a drive that a test wrote as lines [kind, seconds, nanoseconds, numbers...]."""
    start = genpy.Time(1, 0)
    tf = CLASSES["tf2_msgs/TFMessage"]()
    tf.transforms = [transform(start, "base_link", child, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
                     for child in ("laser", "imu_link")]
    yield "/tf_static", tf, start
    for line in file.read_text().splitlines():
        kind, seconds, nanoseconds, *values = json.loads(line)
        stamp = genpy.Time(seconds, nanoseconds)
        if kind == "odometry":
            message = with_header("nav_msgs/Odometry", stamp, "odom")
            message.child_frame_id = "base_link"
            set_fields(message.pose.pose.position, x=values[0], y=values[1])
            set_fields(message.pose.pose.orientation, z=math.sin(values[2] / 2), w=math.cos(values[2] / 2))
            yield "/odom", message, stamp
        elif kind == "field":
            message = with_header("sensor_msgs/MagneticField", stamp, "imu_link")
            set_fields(message.magnetic_field, x=1e-6 * values[0], y=1e-6 * values[1], z=1e-6 * values[2])
            yield "/imu/mag", message, stamp
        elif kind == "scan":
            message = with_header("sensor_msgs/LaserScan", stamp, "laser")
            set_fields(message, angle_min=values[0], angle_increment=values[1], range_min=values[2],
                       range_max=values[3], ranges=values[4])
            yield "/scan", message, stamp


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    with rosbag.Bag(str(folder / "run.bag"), "w", compression="lz4") as bag:
        for topic, message, stamp in recorded(folder / "run.jsonl"):
            bag.write(topic, message, stamp)
    for compression in ("none", "lz4", "bz2"):
        with rosbag.Bag(str(folder / f"{compression}.bag"), "w", compression=compression, chunk_threshold=20000) as bag:
            for topic, message, stamp in drive():
                bag.write(topic, message, stamp)


main()
