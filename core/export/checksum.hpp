// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace unfurl {

// FNV-1a with 64 bits: tells contents apart, does not protect from malice.
class Checksum {
 public:
  void add(std::span<const std::byte> bytes) {
    std::uint64_t value = value_;
#pragma GCC unroll 8
    for (const std::byte b : bytes) value = (value ^ std::to_integer<std::uint64_t>(b)) * 1099511628211ULL;
    value_ = value;
  }
  void add(std::string_view text) {
    add(std::as_bytes(std::span(text.data(), text.size())));
  }

  std::string text() const {  // 16 hexadecimal digits
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(value_));
    return digits.data();
  }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

// Of a regular file that is open, from where it stands; empty where it cannot be read or is something else.
std::string checksum_of(int file);
// Of a file that is no link; empty where it cannot be read.
std::string checksum_of_file(const std::filesystem::path& path);

}  // namespace unfurl
