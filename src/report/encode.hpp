#pragma once

#include <string>
#include <string_view>

namespace mstsl::report {

/// RFC 4648 with padding: the letters that HTML and JavaScript's atob() take.
std::string base64(std::string_view bytes);

/// The bytes in zlib's format, in base64: JavaScript's DecompressionStream('deflate') reads it.
std::string deflated(std::string_view bytes);

/// JSON as it may stand in a <script> element.
std::string inside_script(std::string json);

/// Text as it may stand in an element.
std::string escaped(std::string_view text);

}  // namespace mstsl::report
