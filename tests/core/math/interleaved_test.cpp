// SPDX-License-Identifier: BSD-3-Clause
// Kernels of interleaved vectors as every 64-bit processor computes them beside those for AVX2: no bit may
// differ.
#include "core/math/interleaved.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace interleaved_test {

namespace {

constexpr int rows = 11;

struct Arrays {
  SparseRows A;
  std::vector<double> x, y, T;
};

// Numbers of all sizes, zeros of both signs, infinity and what is not a number.
Arrays random_arrays(int columns, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Arrays out;
  MatrixXd A(rows, rows);
  for (Index i = 0; i < A.size(); ++i) A.data()[i] = random() % 3 == 0 ? uniform(random) : 0.0;
  out.A = testing::sparse_rows(A);
  const auto fill = [&](std::vector<double>& values, int size, bool special) {
    for (int i = 0; i < size; ++i) values.push_back(uniform(random) * std::pow(10.0, 20 * uniform(random)));
    if (!special) return;
    const double strange[] = {
        0.0,      -0.0,    std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(),
        4.9e-324, -1.7e308};
    for (const double value : strange) values[random() % values.size()] = value;
  };
  fill(out.x, rows * columns, true);
  fill(out.y, rows * columns, true);
  fill(out.T, columns * columns, false);
  return out;
}

// All that lanes can do, one result behind the other.
template <LaneCount K>
void all_operations(const Arrays& a, double* out) {
  using Row = Lanes<K>;
  Row sum = Row::all(0.0), most = sum;
  for (Index i = 0; i < rows; ++i) {
    const Row x(a.x.data() + i * K), y(a.y.data() + i * K);
    for (const Row& result :
         {x + y, x - y, x * y, x / y, 0.3 * x, larger(x, y), row_times<K>(a.A, i, a.x.data()),
          mixed<K>(x, a.y.data() + i * K, a.T.data())}) {
      result.store(out);
      out += K;
    }
    sum = sum + x;
    most = larger(most, y);
    *out++ = x.sum();
  }
  most.store(out);
  out[K] = most.largest();
  out[K + 1] = sum.sum();
}

template <int width>
std::vector<double> results(int columns, const Arrays& arrays) {
  std::vector<double> out(static_cast<std::size_t>(rows * (8 * columns + 1) + columns + 2));
  with_columns<width>(columns, [&arrays, to = out.data()](auto k) { all_operations<k()>(arrays, to); });
  return out;
}

}  // namespace

// Of what is not a number the bits do not matter.
std::size_t differing(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    count += std::isnan(a[i]) ? !std::isnan(b[i]) : std::memcmp(&a[i], &b[i], sizeof(double)) != 0;
  return count;
}

TEST_CASE("wide lanes give the bits of narrow ones, numbers that are none included") {
  std::mt19937 random(20261123);
  for (int columns = 1; columns <= most_columns; ++columns)
    for (int trial = 0; trial < 50; ++trial) {
      const Arrays arrays = random_arrays(columns, random);
      const std::vector<double> narrow = results<2>(columns, arrays);
      INFO(columns << " columns, trial " << trial);
      std::vector<double> widest;
      with_widest([columns, &arrays, &widest](auto width) { widest = results<width()>(columns, arrays); });
      CHECK(differing(narrow, widest) == 0);
      if (columns != most_columns) continue;
      with_wide<most_columns>([&arrays, &widest](auto lanes) {
        std::fill(widest.begin(), widest.end(), 0.0);
        all_operations<lanes()>(arrays, widest.data());
      });
      CHECK(differing(narrow, widest) == 0);
    }
}

TEST_CASE("the largest magnitude passes over what is not a number") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x{0.5, -3.25, nan, 2.0, nan, 3.0, -0.0, 1e-300, 3.2};
  CHECK(largest_magnitude(x.data(), std::ssize(x)) == 3.25);
  CHECK(largest_magnitude(x.data() + 2, 1) == 0.0);
  CHECK(largest_magnitude(x.data(), 0) == 0.0);
  CHECK(all_finite(x.data(), 2));
  CHECK(!all_finite(x.data(), std::ssize(x)));
}

}  // namespace interleaved_test
