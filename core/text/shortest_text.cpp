// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/shortest_text.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace unfurl {
namespace {

// R. Giulietti, "The Schubfach way to render doubles" (2020). x = c 2^q stands for every number of
// [(c - 1/2) 2^q, (c + 1/2) 2^q], ends included where c is even. With 10^k <= 2^q < 10^(k+1) that interval
// holds one or two multiples of 10^k, and of 10^(k+1) one at most, which is the shorter text:
//
//     v = 4 c 2^q / 10^k,   v_l = v - 2 2^q / 10^k,   v_r = v + 2 2^q / 10^k
//
// compared with multiples of 4 (of 40). Only whether they are multiples or lie between two matters, so that
// their integer parts will do, odd where something is lost ("round to odd"). Here k <= 0, and 10^-k is known
// exactly: 5^-k < 2^128 for -k <= 55.

__extension__ using Wide = unsigned __int128;
using std::uint64_t;

constexpr int fraction_bits = 52, bias = 1075, most_power = 55;

struct Power {
  uint64_t high, low;  // 10^j 2^-s, its highest bit at the top
};

constexpr std::array<Power, most_power + 1> powers = [] {
  std::array<Power, most_power + 1> out{};
  Wide five = 1;
  for (Power& p : out) {
    Wide top = five;
    while (top >> 127U == 0) top <<= 1U;
    p = {static_cast<uint64_t>(top >> 64U), static_cast<uint64_t>(top)};
    five *= 5;
  }
  return out;
}();

// The integer part of g a / 2^128, odd where it is not all.
uint64_t round_to_odd(const Power& g, uint64_t a) {
  const Wide low = static_cast<Wide>(g.low) * a;
  const Wide all = static_cast<Wide>(g.high) * a + static_cast<uint64_t>(low >> 64U);
  return static_cast<uint64_t>(all >> 64U) | (static_cast<uint64_t>(all) > 1 ? 1U : 0U);
}

struct Decimal {
  uint64_t digits;
  int exponent;
};

// Of c 2^q with -183 <= q < 0. `even_gap`: the number below is as far as the one above.
Decimal shortest(uint64_t c, int q, bool even_gap) {
  const int k = (q * 1262611 - (even_gap ? 0 : 524031)) >> 22;  // floor(log10 2^q), or of 3/4 2^q
  const int shift = q + ((-k * 1741647) >> 19) + 1;             // floor(log2 10^-k)
  const Power& g = powers[static_cast<std::size_t>(-k)];
  const uint64_t out = c % 2;  // ends do not belong to the interval
  const uint64_t v = round_to_odd(g, (4 * c) << shift);
  const uint64_t low = round_to_odd(g, (4 * c - (even_gap ? 2U : 1U)) << shift) + out;
  const uint64_t high = round_to_odd(g, (4 * c + 2) << shift) - out;
  const uint64_t s = v / 4;
  if (s >= 10) {
    const uint64_t tens = s / 10;
    const bool below = low <= 40 * tens, above = 40 * tens + 40 <= high;
    if (below != above) return {tens + (above ? 1U : 0U), k + 1};
  }
  const bool below = low <= 4 * s, above = 4 * s + 4 <= high;
  if (below != above) return {s + (above ? 1U : 0U), k};
  const uint64_t middle = 4 * s + 2;
  return {s + (v > middle || (v == middle && s % 2 == 1) ? 1U : 0U), k};
}

constexpr std::array<char, 200> pairs = [] {
  std::array<char, 200> out{};
  for (std::size_t i = 0; i < 100; ++i) {
    out[2 * i] = static_cast<char>('0' + i / 10);
    out[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return out;
}();

void write_pair(std::uint32_t x, char* to) {
  std::memcpy(to, pairs.data() + static_cast<std::size_t>(2) * x, 2);
}

void write_eight(std::uint32_t x, char* to) {
  const std::uint32_t high = x / 10'000, low = x % 10'000;
  write_pair(high / 100, to);
  write_pair(high % 100, to + 2);
  write_pair(low / 100, to + 4);
  write_pair(low % 100, to + 6);
}

// The digits of a number below 10^18, in pieces of fixed size, which cost no calls: whoever copies them takes
// `room` characters wherever he begins.
constexpr std::size_t most_digits = 18, room = 24;

struct Digits {
  explicit Digits(uint64_t x) {
    constexpr uint64_t eight = 100'000'000;
    const uint64_t high = x / eight;
    write_pair(static_cast<std::uint32_t>(high / eight), all.data());
    write_eight(static_cast<std::uint32_t>(high % eight), all.data() + 2);
    write_eight(static_cast<std::uint32_t>(x % eight), all.data() + 10);
    while (*first == '0') ++first;
    const char* end = all.data() + most_digits;
    while (end[-1] == '0') --end, ++zeros;
    count = static_cast<int>(end - first);
  }
  Digits(const Digits&) = delete;
  Digits& operator=(const Digits&) = delete;
  ~Digits() = default;

  std::array<char, most_digits + room> all{};
  const char* first = all.data();  // that is no zero
  int count = 0, zeros = 0;        // up to the last one that is none, and behind it
};

char* write_fixed(const Digits& d, int exponent, char* to) {
  const int before = d.count + exponent;  // digits in front of the point
  if (before <= 0) {
    std::memcpy(to, "0.000000", 8);  // three at most: the other way is shorter then
    std::memcpy(to + 2 - before, d.first, room);
    return to + 2 - exponent;
  }
  std::memcpy(to, d.first, room);
  if (exponent >= 0) {
    std::memset(to + d.count, '0', room);
    return to + before;
  }
  to[before] = '.';
  std::memcpy(to + before + 1, d.first + before, room);
  return to + d.count + 1;
}

char* write_scientific(const Digits& d, int exponent, char* to) {
  to[0] = *d.first;
  to[1] = '.';
  std::memcpy(to + 2, d.first + 1, room);
  to += d.count > 1 ? d.count + 1 : 1;
  const int power = exponent + d.count - 1;  // below 100
  to[0] = 'e';
  to[1] = power < 0 ? '-' : '+';
  write_pair(static_cast<std::uint32_t>(std::abs(power)), to + 2);
  return to + 4;
}

}  // namespace

char* shortest_text(double x, char* text) {
  const auto bits = std::bit_cast<uint64_t>(x);
  const uint64_t fraction = bits & ((uint64_t{1} << fraction_bits) - 1);
  const int q = static_cast<int>(bits >> fraction_bits & 0x7ffU) - bias;
  if (q < -182 || q >= 0) return std::to_chars(text, text + longest_number, x).ptr;
  const uint64_t c = fraction | uint64_t{1} << fraction_bits;
  Decimal value{c, 0};
  if (q > -fraction_bits - 1 && (c & ((uint64_t{1} << -q) - 1)) == 0)
    value.digits = c >> -q;  // an integer
  else
    value = shortest(c, q, fraction != 0);
  const Digits d(value.digits);
  const int exponent = value.exponent + d.zeros;
  const int fixed = exponent >= 0 ? d.count + exponent : exponent > -d.count ? d.count + 1 : 2 - exponent;
  const int scientific = d.count + (d.count > 1 ? 1 : 0) + 4;
  std::array<char, 3 * room> out;
  out[0] = '-';
  const bool negative = bits >> 63U != 0;
  char* const begin = out.data() + (negative ? 1 : 0);
  const char* const end =
      fixed <= scientific ? write_fixed(d, exponent, begin) : write_scientific(d, exponent, begin);
  const std::ptrdiff_t size = end - out.data();
  std::memcpy(text, out.data(), static_cast<std::size_t>(size));
  return text + size;
}

}  // namespace unfurl
