#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include "mstsl/core/random.hpp"

#include "bag_support.hpp"
#include "io/bag/bag_log.hpp"
#include "io/compression.hpp"
#include "io/mcap/mcap_log.hpp"
#include "message_support.hpp"

/// Reading speed, in megabytes of messages a second (unpacked, as a robot's sensors made them): of the
/// containers alone, and of play() with decoding, ordering and checks. The files lie in the page cache.
namespace {

using namespace mstsl;
using namespace mstsl::test;

constexpr double kSeconds = 120.0;
constexpr std::size_t kBeams = 1081;  // a UTM-30LX

const TemporaryFolder& folder() {
  static const TemporaryFolder folder;
  return folder;
}

/// The drive as RecordingWriter writes it: MCAP packed with zstd.
const std::filesystem::path& zstd_mcap() {
  static const std::filesystem::path path = [] {
    Random random(1);
    auto file = folder().path() / "zstd.mcap";
    write_log(file, random_drive(random, kSeconds, kBeams));
    return file;
  }();
  return path;
}

/// The same messages in chunks that are not packed.
const std::filesystem::path& plain_mcap() {
  static const std::filesystem::path path = [] {
    using namespace io::mcap;
    auto log = must(io::open_mcap(must(io::InputFile::open(zstd_mcap()))));
    io::ByteBuilder out;
    out.append(io::as_bytes(kMagic));
    append(out, Header{"ros2", "bench"});
    std::uint16_t id = 0;
    for (const io::Channel& channel : log->channels()) {
      append(out, Schema{++id, io::ros::ros2_type_name(channel.type), "ros2msg", ""});
      append(out, io::mcap::Channel{id, id, channel.topic, "cdr", {}});
    }
    io::ByteBuilder chunk;
    const auto flush = [&] {
      append(out, Chunk{0, 0, chunk.bytes().size(), io::crc32(chunk.bytes()), "", chunk.bytes().size(),
                        chunk.bytes()});
      chunk.clear();
    };
    const io::Channel* first = log->channels().data();
    log->read([](const io::Channel&) { return true; },
              [&](const io::RawMessage& message) {
                const auto time = static_cast<std::uint64_t>(message.log_time.ns);
                const auto channel = static_cast<std::uint16_t>(message.channel - first + 1);
                append(chunk, Message{channel, 0, time, time, message.data});
                if (chunk.bytes().size() > (1 << 20)) flush();
                return true;
              },
              nullptr);
    flush();
    append_data_end(out, 0);
    append(out, Footer{});
    out.append(io::as_bytes(kMagic));
    auto file = folder().path() / "plain.mcap";
    write_bytes(file, io::as_text(out.bytes()));
    return file;
  }();
  return path;
}

/// The same number of bytes in a bag whose chunks are not packed.
const std::filesystem::path& plain_bag() {
  static const std::filesystem::path path = [] {
    BagBuilder bag({true, true});
    auto log = must(io::open_mcap(must(io::InputFile::open(zstd_mcap()))));
    std::uint32_t id = 0;
    for (const io::Channel& channel : log->channels()) bag.connect(id++, channel.topic, channel.type);
    std::size_t size = 0;
    const io::Channel* first = log->channels().data();
    log->read([](const io::Channel&) { return true; },
              [&](const io::RawMessage& message) {
                bag.write(static_cast<std::uint32_t>(message.channel - first), message.log_time,
                          io::as_text(message.data));
                size += message.data.size();
                if (size > 768 * 1024) bag.end_chunk();
                if (size > 768 * 1024) size = 0;
                return true;
              },
              nullptr);
    auto file = folder().path() / "plain.bag";
    write_bytes(file, bag.finish());
    return file;
  }();
  return path;
}

using Open = Result<std::unique_ptr<io::MessageLog>> (*)(io::InputFile);

void read_messages(benchmark::State& state, const std::filesystem::path& path, Open open) {
  std::int64_t bytes = 0;
  for (auto _ : state) {
    auto log = must(open(must(io::InputFile::open(path))));
    io::PlayReport report;
    log->read([](const io::Channel&) { return true; },
              [&bytes](const io::RawMessage& message) {
                bytes += static_cast<std::int64_t>(message.data.size());
                return true;
              },
              &report);
  }
  state.SetBytesProcessed(bytes);
}

void BM_ReadZstdMcap(benchmark::State& state) { read_messages(state, zstd_mcap(), io::open_mcap); }
void BM_ReadPlainMcap(benchmark::State& state) { read_messages(state, plain_mcap(), io::open_mcap); }
void BM_ReadPlainBag(benchmark::State& state) { read_messages(state, plain_bag(), io::open_bag); }

void play_events(benchmark::State& state, const std::filesystem::path& path) {
  std::int64_t bytes = 0;
  for (auto _ : state) {
    must(io::play({path}, {}, {}, [&bytes](const SensorEvent& event) {
      const auto* scan = std::get_if<LaserScan>(&event);
      bytes += scan != nullptr ? static_cast<std::int64_t>(4 * scan->ranges_m.size()) : 300;
      return true;
    }));
  }
  state.SetBytesProcessed(bytes);
}

void BM_PlayZstdMcap(benchmark::State& state) { play_events(state, zstd_mcap()); }
void BM_PlayPlainMcap(benchmark::State& state) { play_events(state, plain_mcap()); }

BENCHMARK(BM_ReadZstdMcap)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadPlainMcap)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadPlainBag)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlayZstdMcap)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlayPlainMcap)->Unit(benchmark::kMillisecond);

}  // namespace
