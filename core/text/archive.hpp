// SPDX-License-Identifier: BSD-3-Clause
// Numbers and text as bytes, exactly, to be read again by the same program.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/text/error.hpp"

namespace unfurl {

struct ArchiveError : Error {
  using Error::Error;
};

// One function says what is written and what is read: archive(x) appends x, or sets it from what was
// appended. Sums of numbers are told by their bits; in the order of bytes of this machine.
class Archive {
 public:
  Archive() = default;  // to write into
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reading_(true) {}

  bool reading() const { return reading_; }
  const std::string& bytes() const { return bytes_; }

  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void operator()(T& x) { raw(&x, sizeof x); }
  void operator()(std::string& text) {
    text.resize(size(text.size(), 1));
    raw(text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    list.resize(size(list.size(), 1));
    if constexpr (std::is_same_v<T, bool>) {
      for (std::size_t i = 0; i < list.size(); ++i) {
        char bit = list[i] ? 1 : 0;
        (*this)(bit);
        list[i] = bit != 0;
      }
    } else if constexpr (std::is_arithmetic_v<T>) {
      raw(list.data(), list.size() * sizeof(T));
    } else {
      for (T& x : list) (*this)(x);
    }
  }
  // A vector or matrix of Eigen's, column by column.
  template <class M>
  requires requires(M& m) {
    m.resize(m.rows(), m.cols());
    m.data();
  }
  void operator()(M& m) {
    const std::size_t rows = size(static_cast<std::size_t>(m.rows()), 0),
                      columns = size(static_cast<std::size_t>(m.cols()), 0);
    if (rows != 0 && columns > (bytes_.size() + 1) / rows + static_cast<std::size_t>(m.size())) short_of();
    m.resize(static_cast<std::ptrdiff_t>(rows), static_cast<std::ptrdiff_t>(columns));
    raw(m.data(), static_cast<std::size_t>(m.size()) * sizeof(*m.data()));
  }
  // Whatever says by itself what it is.
  template <class T>
  requires requires(T& x, Archive& a) { x.archive(a); }
  void operator()(T& x) { x.archive(*this); }

 private:
  // A length that the rest can hold, each entry in so many bytes at least.
  std::size_t size(std::size_t now, std::size_t each) {
    std::uint64_t n = now;
    raw(&n, sizeof n);
    if (reading_ && n * each > bytes_.size() - at_) short_of();
    return n;
  }
  void raw(void* x, std::size_t count) {
    if (!reading_) {
      if (count > 0) bytes_.append(static_cast<const char*>(x), count);
      return;
    }
    if (count > bytes_.size() - at_) short_of();
    if (count > 0) std::memcpy(x, bytes_.data() + at_, count);
    at_ += count;
  }
  [[noreturn]] static void short_of() { throw ArchiveError("ends too early"); }

  std::string bytes_;
  std::size_t at_ = 0;
  bool reading_ = false;
};

}  // namespace unfurl
