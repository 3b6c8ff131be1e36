// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/base64.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

using namespace unfurl;

namespace base64_test {

TEST_CASE("bytes of every length and value are written as RFC 4648 says") {
  const auto of = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  // Its section 10.
  CHECK(of("").empty());
  CHECK(of("f") == "Zg==");
  CHECK(of("fo") == "Zm8=");
  CHECK(of("foo") == "Zm9v");
  CHECK(of("foob") == "Zm9vYg==");
  CHECK(of("fooba") == "Zm9vYmE=");
  CHECK(of("foobar") == "Zm9vYmFy");
  std::mt19937 dice(4648);
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t size = 0; size < 100; ++size) {
    std::string bytes(size, ' '), again;
    for (char& c : bytes) c = static_cast<char>(dice());
    unsigned bits = 0, count = 0;
    for (const char c : of(bytes)) {
      if (c == '=') break;
      bits = bits << 6U | static_cast<unsigned>(digits.find(c));
      if ((count += 6) < 8) continue;
      count -= 8;
      again += static_cast<char>(bits >> count & 255U);
    }
    CHECK(again == bytes);
    CHECK(of(bytes).size() == (size + 2) / 3 * 4);
  }
}

}  // namespace base64_test
