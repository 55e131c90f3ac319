// Writes the reference drive (see reference_drive.hpp) as MCAP with @mcap/core and @foxglove/rosmsg2-serialization.
//
// usage: node write_mcaps.mjs FOLDER
// Makes none.mcap, lz4.mcap and zstd.mcap (chunks), flat.mcap (no chunks), unindexed.mcap (chunks, but no summary),
// and run.mcap of the drive in run.jsonl.
import { McapWriter } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4js";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const SEPARATOR = "=".repeat(80);
const DEFINITIONS = {
  "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
  "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
  "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
  "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
  "geometry_msgs/Quaternion": "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n",
  "geometry_msgs/Pose": "Point position\nQuaternion orientation\n",
  "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance\n",
  "geometry_msgs/Twist": "Vector3 linear\nVector3 angular\n",
  "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance\n",
  "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation\n",
  "geometry_msgs/TransformStamped": "std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
  "geometry_msgs/PoseStamped": "std_msgs/Header header\nPose pose\n",
  "nav_msgs/Odometry":
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n" +
    "geometry_msgs/TwistWithCovariance twist\n",
  "sensor_msgs/LaserScan":
    "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n" +
    "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n",
  "sensor_msgs/MagneticField":
    "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance\n",
  "sensor_msgs/Imu":
    "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n" +
    "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n" +
    "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
  "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
};

function schemaText(type) {
  const others = Object.entries(DEFINITIONS).filter(([name]) => name !== type);
  return DEFINITIONS[type] + others.map(([name, text]) => `${SEPARATOR}\nMSG: ${name}\n${text}`).join("");
}

const stampOf = (step) => ({ sec: 1000 + Math.floor(step / 8), nanosec: (step % 8) * 125_000_000 });
const header = (step, frame) => ({ stamp: stampOf(step), frame_id: frame });
const vector = (x, y, z) => ({ x, y, z });
const turned = { x: 0, y: 0, z: 0.6, w: 0.8 };
const straight = { x: 0, y: 0, z: 0, w: 1 };
const zeros = (n) => new Array(n).fill(0);

function transform(parent, child, translation, rotation) {
  return { header: header(0, parent), child_frame_id: child, transform: { translation, rotation } };
}

function* drive() {
  yield ["/tf_static", "tf2_msgs/TFMessage", 0, {
    transforms: [
      transform("base_link", "deck", vector(0.25, 0, 0.5), turned),
      transform("deck", "laser", vector(0, 0.125, 0), straight),
      transform("imu_link", "base_link", vector(0, 0, -1), { x: 1, y: 0, z: 0, w: 0 }),
    ],
  }];
  for (let i = 0; i < 200; i++) {
    yield ["/odom", "nav_msgs/Odometry", i, {
      header: header(i, "odom"),
      child_frame_id: "base_link",
      pose: { pose: { position: vector(0.125 * i, -0.0625 * i, 0), orientation: turned }, covariance: zeros(36) },
      twist: { twist: { linear: vector(0, 0, 0), angular: vector(0, 0, 0) }, covariance: zeros(36) },
    }];
    yield ["/imu/mag", "sensor_msgs/MagneticField", i, {
      header: header(i, "imu_link"), magnetic_field: vector(2e-5, 1e-9 * i, -4e-5), magnetic_field_covariance: zeros(9),
    }];
    yield ["/imu/data", "sensor_msgs/Imu", i, {
      header: header(i, "imu_link"), orientation: turned, orientation_covariance: zeros(9),
      angular_velocity: vector(0.5, -0.25, 0.125 * i), angular_velocity_covariance: zeros(9),
      linear_acceleration: vector(0, 0, 9.81), linear_acceleration_covariance: zeros(9),
    }];
    yield ["/ground_truth", "geometry_msgs/PoseStamped", i, {
      header: header(i, "map"), pose: { position: vector(10 + 0.125 * i, 5, 0), orientation: straight },
    }];
    yield ["/scan", "sensor_msgs/LaserScan", i, {
      header: header(i, "laser"), angle_min: 1.5, angle_max: -1.5, angle_increment: -0.125,
      time_increment: 0.0009765625, scan_time: 0, range_min: 0.125, range_max: 30,
      ranges: Array.from({ length: 25 }, (_, beam) => 1 + (i + beam) / 64), intensities: [],
    }];
  }
}

// The messages of a drive that a test wrote as lines [kind, seconds, nanoseconds, numbers...].
function* recorded(path) {
  const still = { translation: vector(0, 0, 0), rotation: straight };
  const fixed = (child) => ({ header: header(0, "base_link"), child_frame_id: child, transform: still });
  yield ["/tf_static", "tf2_msgs/TFMessage", 0, { transforms: [fixed("laser"), fixed("imu_link")] }];
  for (const line of readFileSync(path, "utf8").trim().split("\n")) {
    const [kind, sec, nanosec, ...v] = JSON.parse(line);
    const at = (frame) => ({ stamp: { sec, nanosec }, frame_id: frame });
    if (kind === "odometry") {
      const orientation = { x: 0, y: 0, z: Math.sin(v[2] / 2), w: Math.cos(v[2] / 2) };
      yield ["/odom", "nav_msgs/Odometry", 0, {
        header: at("odom"),
        child_frame_id: "base_link",
        pose: { pose: { position: vector(v[0], v[1], 0), orientation }, covariance: zeros(36) },
        twist: { twist: { linear: vector(0, 0, 0), angular: vector(0, 0, 0) }, covariance: zeros(36) },
      }];
    } else if (kind === "field") {
      yield ["/imu/mag", "sensor_msgs/MagneticField", 0, {
        header: at("imu_link"), magnetic_field: vector(1e-6 * v[0], 1e-6 * v[1], 1e-6 * v[2]),
        magnetic_field_covariance: zeros(9),
      }];
    } else if (kind === "scan") {
      yield ["/scan", "sensor_msgs/LaserScan", 0, {
        header: at("laser"), angle_min: v[0], angle_max: 0, angle_increment: v[1], time_increment: 0, scan_time: 0,
        range_min: v[2], range_max: v[3], ranges: v[4], intensities: [],
      }];
    }
  }
}

class MemoryFile {
  pieces = [];
  size = 0n;
  position() { return this.size; }
  async write(piece) {
    this.pieces.push(Buffer.from(piece));
    this.size += BigInt(piece.byteLength);
  }
}

async function writeMcap(path, options, messages = drive()) {
  const file = new MemoryFile();
  const writer = new McapWriter({ writable: file, chunkSize: 20_000, ...options });
  await writer.start({ profile: "ros2", library: "interop" });
  const channels = new Map();
  let sequence = 0;
  for (const [topic, type, step, message] of messages) {
    if (!channels.has(topic)) {
      const text = schemaText(type);
      const schemaId = await writer.registerSchema({
        name: type.replace("/", "/msg/"), encoding: "ros2msg", data: new TextEncoder().encode(text),
      });
      const id = await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() });
      channels.set(topic, { id, serializer: new MessageWriter(parse(text, { ros2: true })) });
    }
    const { id, serializer } = channels.get(topic);
    const { sec, nanosec } = message.header?.stamp ?? stampOf(step);
    const logTime = BigInt(sec) * 1_000_000_000n + BigInt(nanosec);
    await writer.addMessage({
      channelId: id, sequence: sequence++, logTime, publishTime: logTime, data: serializer.writeMessage(message),
    });
  }
  await writer.end();
  writeFileSync(path, Buffer.concat(file.pieces));
}

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
await zstd.isLoaded;
const without = {
  useStatistics: false, useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false, useMessageIndex: false,
  useChunkIndex: false,
};
await writeMcap(join(folder, "none.mcap"), {});
await writeMcap(join(folder, "flat.mcap"), { useChunks: false });
await writeMcap(join(folder, "unindexed.mcap"), without);
await writeMcap(join(folder, "lz4.mcap"), {
  compressChunk: (data) => ({ compression: "lz4", compressedData: Uint8Array.from(lz4.compress(data)) }),
});
const byZstd = { compressChunk: (data) => ({ compression: "zstd", compressedData: zstd.compress(data) }) };
await writeMcap(join(folder, "zstd.mcap"), byZstd);
await writeMcap(join(folder, "run.mcap"), byZstd, recorded(join(folder, "run.jsonl")));
