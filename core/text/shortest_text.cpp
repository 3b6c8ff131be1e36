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

// All 20 digits, zeros in front; returns the first that is none.
const char* digits_of(uint64_t x, std::array<char, 20>& text) {
  char* at = text.data() + text.size();
  for (; x >= 100; x /= 100) std::memcpy(at -= 2, pairs.data() + 2 * (x % 100), 2);
  if (x >= 10) {
    std::memcpy(at -= 2, pairs.data() + 2 * x, 2);
    return at;
  }
  *--at = static_cast<char>('0' + x);
  return at;
}

char* copied(const char* from, int count, char* to) {
  std::memcpy(to, from, static_cast<std::size_t>(count));
  return to + count;
}

char* zeros(int count, char* to) {
  std::memset(to, '0', static_cast<std::size_t>(count));
  return to + count;
}

char* written_fixed(const char* digits, int count, int exponent, char* to) {
  const int before = count + exponent;  // digits in front of the point
  if (exponent >= 0) return zeros(exponent, copied(digits, count, to));
  if (before > 0) {
    to = copied(digits, before, to);
    *to++ = '.';
    return copied(digits + before, count - before, to);
  }
  *to++ = '0';
  *to++ = '.';
  return copied(digits, count, zeros(-before, to));
}

char* written_scientific(const char* digits, int count, int exponent, char* to) {
  *to++ = digits[0];
  if (count > 1) *to++ = '.';
  to = copied(digits + 1, count - 1, to);
  const int power = exponent + count - 1, size = std::abs(power);  // below 100
  *to++ = 'e';
  *to++ = power < 0 ? '-' : '+';
  return copied(pairs.data() + static_cast<std::ptrdiff_t>(2) * size, 2, to);
}

}  // namespace

char* shortest_text(double x, char* text) {
  const auto bits = std::bit_cast<uint64_t>(x);
  const uint64_t fraction = bits & ((uint64_t{1} << fraction_bits) - 1);
  const int q = static_cast<int>(bits >> fraction_bits & 0x7ffU) - bias;
  if (q < -182 || q >= 0) return std::to_chars(text, text + longest_number, x).ptr;
  if (bits >> 63U != 0) *text++ = '-';
  const uint64_t c = fraction | uint64_t{1} << fraction_bits;
  Decimal d{c, 0};
  if (q > -fraction_bits - 1 && (c & ((uint64_t{1} << -q) - 1)) == 0)
    d.digits = c >> -q;  // an integer
  else
    d = shortest(c, q, fraction != 0);
  for (; d.digits % 10 == 0; d.digits /= 10) ++d.exponent;
  std::array<char, 20> all{};
  const char* const digits = digits_of(d.digits, all);
  const int count = static_cast<int>(all.data() + all.size() - digits);
  const int fixed = d.exponent >= 0 ? count + d.exponent : d.exponent > -count ? count + 1 : 2 - d.exponent;
  const int scientific = count + (count > 1 ? 1 : 0) + 4;
  return fixed <= scientific ? written_fixed(digits, count, d.exponent, text)
                             : written_scientific(digits, count, d.exponent, text);
}

}  // namespace unfurl
