// Reads the reference drive (see reference_drive.hpp) as mstsl wrote it, once from front to back with every CRC
// checked and once by its index, and compares each value.
//
// usage: node read_mcap.mjs FILE
import { crc32 } from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

await zstd.isLoaded;
const file = readFileSync(process.argv[2]);
const decompressHandlers = { zstd: (buffer, size) => zstd.decompress(buffer, Number(size)) };
const near = (a, b, tolerance, what) => assert.ok(Math.abs(a - b) <= tolerance, `${what}: ${a} is not ${b}`);

const schemas = new Map();
const channels = new Map();
const steps = new Map();

const checks = {
  "/odom": (m, i) => {
    assert.equal(m.header.frame_id, "odom");
    assert.equal(m.child_frame_id, "base_link");
    assert.equal(m.pose.pose.position.x, 0.125 * i);
    assert.equal(m.pose.pose.position.y, -0.0625 * i);
    near(m.pose.pose.orientation.z, 0.6, 1e-15, "orientation.z");
    near(m.pose.pose.orientation.w, 0.8, 1e-15, "orientation.w");
  },
  "/imu/mag": (m, i) => {
    assert.equal(m.header.frame_id, "imu_link");
    near(m.magnetic_field.x, 2e-5, 1e-19, "field.x");
    near(m.magnetic_field.y, 1e-9 * i, 1e-19, "field.y");
    near(m.magnetic_field.z, -4e-5, 1e-19, "field.z");
  },
  "/imu/data": (m, i) => {
    assert.deepEqual(m.angular_velocity, { x: 0.5, y: -0.25, z: 0.125 * i });
    assert.equal(m.orientation.z, 0.6);
    assert.equal(m.linear_acceleration_covariance[0], -1);
  },
  "/ground_truth": (m, i) => {
    assert.equal(m.header.frame_id, "map");
    assert.deepEqual(m.pose.position, { x: 10 + 0.125 * i, y: 5, z: 0 });
  },
  "/scan": (m, i) => {
    assert.equal(m.header.frame_id, "laser");
    assert.equal(m.angle_min, 1.5);
    assert.equal(m.angle_max, -1.5);
    assert.equal(m.angle_increment, -0.125);
    assert.deepEqual([...m.ranges], Array.from({ length: 25 }, (_, beam) => 1 + (i + beam) / 64));
  },
  "/tf_static": (m) => {
    assert.deepEqual(m.transforms.map((t) => t.child_frame_id), ["laser", "imu_link"]);
    assert.equal(m.transforms[0].header.frame_id, "base_link");
    near(m.transforms[0].transform.translation.z, 0.5, 1e-15, "translation.z");
    near(Math.abs(m.transforms[1].transform.rotation.x), 1, 1e-15, "rotation.x");
  },
};

function take(record) {
  if (record.type === "Schema") {
    assert.equal(record.encoding, "ros2msg");
    schemas.set(record.id, parse(new TextDecoder().decode(record.data), { ros2: true }));
  } else if (record.type === "Channel") {
    assert.equal(record.messageEncoding, "cdr");
    channels.set(record.id, { topic: record.topic, reader: new MessageReader(schemas.get(record.schemaId)) });
  } else if (record.type === "Message") {
    const { topic, reader } = channels.get(record.channelId);
    const step = steps.get(topic) ?? 0;
    steps.set(topic, step + 1);
    const message = reader.readMessage(record.data);
    assert.equal(reader.lastReadHadTrailingBytes(), false, `${topic}: bytes behind the message`);
    assert.equal(record.logTime, 1_000_000_000_000n + 125_000_000n * BigInt(step), `${topic}: log time`);
    if (message.header) {
      const { sec, nanosec } = message.header.stamp;
      assert.equal(BigInt(sec) * 1_000_000_000n + BigInt(nanosec), record.logTime, `${topic}: stamp`);
    }
    checks[topic](message, step);
  }
}

const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(file);
let dataEnd = null;
let footer = null;
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) {
  take(record);
  if (record.type === "DataEnd") dataEnd = record;
  if (record.type === "Header") assert.equal(record.profile, "ros2");
  if (record.type === "Footer") footer = record;
}
assert.ok(stream.done(), "the file does not end as it should");
// @mcap/core checks the CRC of each chunk; those of the data and the summary it hands out unchecked.
const summaryStart = Number(footer.summaryStart);
assert.equal(crc32(file.subarray(0, summaryStart - 13)), dataEnd.dataSectionCrc, "CRC of the data section");
assert.equal(crc32(file.subarray(summaryStart, file.byteLength - 12)), footer.summaryCrc, "CRC of the summary");
assert.deepEqual([...steps.entries()].sort(), [
  ["/ground_truth", 200], ["/imu/data", 200], ["/imu/mag", 200], ["/odom", 200], ["/scan", 200], ["/tf_static", 1],
]);

const readable = {
  size: async () => BigInt(file.byteLength),
  read: async (offset, size) => new Uint8Array(file.buffer, file.byteOffset + Number(offset), Number(size)),
};
const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
assert.equal(indexed.statistics.messageCount, 1001n);
let scans = 0;
for await (const message of indexed.readMessages({ topics: ["/scan"], validateCrcs: true })) {
  assert.equal(message.logTime, 1_000_000_000_000n + 125_000_000n * BigInt(scans++));
}
assert.equal(scans, 200);
console.log("@mcap/core agrees: 1001 messages, all CRCs, all values");
