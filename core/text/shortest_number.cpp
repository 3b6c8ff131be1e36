// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/shortest_number.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>

namespace unfurl {
namespace {

__extension__ typedef unsigned __int128 Wide;
using Word = std::uint64_t;

constexpr int exact_powers = 56;  // 5^55 < 2^128

// 5^k 2^j with its highest bit at 2^127.
constexpr std::array<Wide, exact_powers> make_powers() {
  std::array<Wide, exact_powers> table{};
  Wide power = 1;
  for (int k = 0; k < exact_powers; ++k, power *= 5) {
    Wide aligned = power;
    while (!(aligned >> 127U)) aligned <<= 1U;
    table[static_cast<std::size_t>(k)] = aligned;
  }
  return table;
}
constexpr std::array<Wide, exact_powers> powers = make_powers();

constexpr std::array<char, 200> make_pairs() {
  std::array<char, 200> table{};
  for (int i = 0; i < 100; ++i) {
    table[static_cast<std::size_t>(2 * i)] = static_cast<char>('0' + i / 10);
    table[static_cast<std::size_t>(2 * i + 1)] = static_cast<char>('0' + i % 10);
  }
  return table;
}
constexpr std::array<char, 200> pairs = make_pairs();

struct Decimal {
  Word digits;
  int exponent;  // of ten
};

// floor(power c / 2^128), the last bit set where something is cut off.
Word product_to_odd(Wide power, Word c) {
  const Wide low = static_cast<Wide>(static_cast<Word>(power)) * c;
  const Wide high = static_cast<Wide>(static_cast<Word>(power >> 64U)) * c + (low >> 64U);
  const bool rest = (static_cast<Word>(high) | static_cast<Word>(low)) != 0;
  return static_cast<Word>(high >> 64U) | Word{rest};
}

// x = c 2^q. What reads as x lies between its neighbours' midpoints, (4 c -+ 2) 2^(q - 2); 10^k is the
// largest power of ten not above the width of that. Multiples of 10^k are counted in quarters, exactly but
// for a last bit that says whether something follows (R. Giulietti, The Schubfach way to render doubles,
// 2021). The powers 10^-k are exact here.
Decimal shortest(Word c, int q, bool lower_is_nearer) {
  const int k = (q * 1262611 - (lower_is_nearer ? 524031 : 0)) >> 22;  // floor(log10(2^q)), of 3/4 2^q
  const int shift = q + ((-k * 1741647) >> 19) + 1;                    // floor(log2(10^-k))
  const Wide power = powers[static_cast<std::size_t>(-k)];
  const Word odd = c & 1U;  // then the midpoints read as the neighbours
  const Word low = product_to_odd(power, (4 * c - 2 + Word{lower_is_nearer}) << shift) + odd,
             value = product_to_odd(power, (4 * c) << shift),
             high = product_to_odd(power, (4 * c + 2) << shift) - odd;
  const Word s = value / 4, tens = s / 10;
  const bool ten_below = low <= 40 * tens, ten_above = 40 * tens + 40 <= high;
  if (s >= 10 && ten_below != ten_above) return {tens + Word{ten_above}, k + 1};
  const bool below = low <= 4 * s, above = 4 * s + 4 <= high;
  if (below != above) return {s + Word{above}, k};
  const Word middle = 4 * s + 2;
  return {s + Word{value > middle || (value == middle && (s & 1U) != 0)}, k};
}

int count_digits(Word x) {
  constexpr Word most = 10000000000000000;  // 17 digits, as most numbers have
  if (x >= most) return 17;
  int n = 16;
  for (Word least = most / 10; x < least; least /= 10) --n;
  return n;
}

// Digits in front of `end`.
void write_digits(char* end, Word digits) {
  const auto pair = [&](std::uint32_t x) {
    end -= 2;
    std::memcpy(end, &pairs[2 * std::size_t{x}], 2);
  };
  while (digits >= 100000000) {
    auto low = static_cast<std::uint32_t>(digits % 100000000);
    digits /= 100000000;
    for (int k = 0; k < 4; ++k, low /= 100) pair(low % 100);
  }
  auto rest = static_cast<std::uint32_t>(digits);
  for (; rest >= 100; rest /= 100) pair(rest % 100);
  if (rest >= 10)
    pair(rest);
  else
    *--end = static_cast<char>('0' + rest);
}

// The digits with a point behind so many of them; the end.
char* write_with_point(char* to, Word digits, int n, int before) {
  write_digits(to + n + 1, digits);
  for (int i = 0; i < before; ++i) to[i] = to[i + 1];
  to[before] = '.';
  return to + n + 1;
}

char* write(char* to, Decimal x) {
  while (x.digits % 10 == 0) x.digits /= 10, ++x.exponent;
  const int n = count_digits(x.digits), e = x.exponent, first = e + n - 1;
  const int fixed = e >= 0 ? n + e : first >= 0 ? n + 1 : 2 - e, scientific = n == 1 ? 5 : n + 5;
  if (fixed > scientific) {
    if (n > 1)
      to = write_with_point(to, x.digits, n, 1);
    else
      *to++ = static_cast<char>('0' + x.digits);
    *to++ = 'e';
    *to++ = first < 0 ? '-' : '+';
    std::memcpy(to, &pairs[2 * static_cast<std::size_t>(first < 0 ? -first : first)], 2);
    return to + 2;
  }
  if (e < 0 && first >= 0) return write_with_point(to, x.digits, n, first + 1);
  if (first < 0) {
    std::memcpy(to, "0.00000", 8);  // no more zeros: scientific would be shorter
    to += 1 - first;
  }
  write_digits(to + n, x.digits);
  if (e > 0) std::memset(to + n, '0', static_cast<std::size_t>(e));
  return to + n + (e > 0 ? e : 0);
}

}  // namespace

char* write_shortest(char* to, double x) {
  if (!(x > 1e-38 && x < 9007199254740992.0)) return std::to_chars(to, to + 31, x).ptr;
  const auto bits = std::bit_cast<Word>(x);
  const Word fraction = bits & ((Word{1} << 52U) - 1), c = fraction | (Word{1} << 52U);
  const int q = static_cast<int>(bits >> 52U) - 1075;
  if (q > -53 && (c & ((Word{1} << static_cast<unsigned>(-q)) - 1)) == 0)
    return write(to, {c >> static_cast<unsigned>(-q), 0});
  return write(to, shortest(c, q, fraction == 0));
}

}  // namespace unfurl
