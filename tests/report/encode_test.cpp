#include "report/encode.hpp"

#include <string>

#include <gtest/gtest.h>
#include <zlib.h>

#include "mstsl/core/random.hpp"

namespace mstsl::report {
namespace {

TEST(Base64, IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

/// An oracle for both: zlib's own uncompress and a decoder that looks letters up one by one.
std::string unpacked(const std::string& text, std::size_t size) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(letters.find(c));
    if ((have += 6) >= 8) bytes += static_cast<char>(bits >> (have -= 8) & 255U);
  }
  std::string out(size + 1, '\0');
  uLongf got = out.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &got,
                       reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  return out.substr(0, got);
}

TEST(Deflated, IsUnpackedByZlib) {
  Random random(3);
  for (const std::size_t size : {0u, 1u, 2u, 3u, 1000u, 100'000u}) {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(random.index(i % 7 == 0 ? 256 : 4));
    EXPECT_EQ(unpacked(deflated(bytes), size), bytes);
  }
}

TEST(InsideScript, EndsNoElement) {
  EXPECT_EQ(inside_script(R"({"a":"</script><!--"})"), R"({"a":"\u003c/script>\u003c!--"})");
  EXPECT_EQ(escaped("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
}

}  // namespace
}  // namespace mstsl::report
