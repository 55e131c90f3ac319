#include "io/compression.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace mstsl::io {
namespace {

/// One call of a library's streaming decompressor.
struct Step {
  std::size_t consumed = 0;
  std::size_t produced = 0;
  bool failed = false;
  bool ended = false;
};

class Zstd {
 public:
  Step step(ByteView in, std::span<std::byte> out) {
    ZSTD_inBuffer source{in.data(), in.size(), 0};
    ZSTD_outBuffer target{out.data(), out.size(), 0};
    const std::size_t status = ZSTD_decompressStream(context_.get(), &target, &source);
    return {source.pos, target.pos, ZSTD_isError(status) != 0, status == 0};
  }

 private:
  struct Free {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
  };
  std::unique_ptr<ZSTD_DStream, Free> context_{ZSTD_createDStream()};
};

class Lz4 {
 public:
  Lz4() { LZ4F_createDecompressionContext(&context_, LZ4F_VERSION); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;
  ~Lz4() { LZ4F_freeDecompressionContext(context_); }
  Step step(ByteView in, std::span<std::byte> out) {
    std::size_t consumed = in.size();
    std::size_t produced = out.size();
    const std::size_t status =
        LZ4F_decompress(context_, out.data(), &produced, in.data(), &consumed, nullptr);
    return {consumed, produced, LZ4F_isError(status) != 0, status == 0};
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class Bzip2 {
 public:
  Bzip2() { ready_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK; }
  Bzip2(const Bzip2&) = delete;
  Bzip2& operator=(const Bzip2&) = delete;
  ~Bzip2() {
    if (ready_) BZ2_bzDecompressEnd(&stream_);
  }
  Step step(ByteView in, std::span<std::byte> out) {
    if (!ready_) return {0, 0, true, false};
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    const auto in_size = static_cast<unsigned>(std::min(in.size(), kMost));
    const auto out_size = static_cast<unsigned>(std::min(out.size(), kMost));
    // bzlib takes a non-const pointer but does not write through it.
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(in.data()));
    stream_.avail_in = in_size;
    stream_.next_out = reinterpret_cast<char*>(out.data());
    stream_.avail_out = out_size;
    const int status = BZ2_bzDecompress(&stream_);
    return {in_size - stream_.avail_in, out_size - stream_.avail_out,
            status != BZ_OK && status != BZ_STREAM_END, status == BZ_STREAM_END};
  }

 private:
  bz_stream stream_{};
  bool ready_ = false;
};

/// Feeds the stream until it ends, fails, has no more input, or gives more than was promised.
template <typename Stream>
Decompressor::Output run(Bytes& buffer, ByteView in, std::uint64_t promised_size) {
  constexpr std::uint64_t kFirstGuess = 4 << 20;
  Stream stream;
  std::size_t filled = 0;
  const auto grow = [&] {
    const std::uint64_t wanted = std::max<std::uint64_t>(kFirstGuess, std::uint64_t{2} * filled);
    const auto size = static_cast<std::size_t>(std::min(promised_size, wanted));
    if (buffer.size() < size) buffer.resize(size);
  };
  bool failed = false;
  bool ended = false;
  while (!failed && !ended) {
    if (filled == std::min<std::uint64_t>(buffer.size(), promised_size)) grow();
    const auto room =
        static_cast<std::size_t>(std::min<std::uint64_t>(buffer.size(), promised_size)) - filled;
    const Step step = stream.step(in, std::span(buffer).subspan(filled, room));
    in = in.subspan(step.consumed);
    filled += step.produced;
    ended = step.ended;
    failed = step.failed || (!ended && step.consumed == 0 && step.produced == 0);
  }
  return {ByteView(buffer).first(filled), ended && filled == promised_size};
}

}  // namespace

bool Decompressor::knows(std::string_view scheme) {
  return scheme.empty() || scheme == "none" || scheme == "lz4" || scheme == "zstd" || scheme == "bz2";
}

Decompressor::Output Decompressor::decompress(std::string_view scheme, ByteView compressed,
                                              std::uint64_t promised_size) {
  if (scheme == "zstd") return run<Zstd>(buffer_, compressed, promised_size);
  if (scheme == "lz4") return run<Lz4>(buffer_, compressed, promised_size);
  if (scheme == "bz2") return run<Bzip2>(buffer_, compressed, promised_size);
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(compressed.size(), promised_size));
  return {compressed.first(size), knows(scheme) && compressed.size() == promised_size};
}

Bytes compress_zstd(ByteView bytes) {
  Bytes compressed(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) return {};
  compressed.resize(size);
  return compressed;
}

std::uint32_t crc32(ByteView bytes, std::uint32_t crc) {
  return static_cast<std::uint32_t>(
      ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace mstsl::io
