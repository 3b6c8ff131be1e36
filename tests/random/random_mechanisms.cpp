// SPDX-License-Identifier: BSD-3-Clause
// random_mechanisms N [FIRST [FEATURES]]: draws mechanisms of the seeds FIRST, FIRST + 1, ... and judges
// each. The first that fails is shrunk and written as a scene, random_SEED.toml.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

#include "tests/random/judge.hpp"

using namespace unfurl::random;

int main(int count, char** words) {
  if (count < 2) return std::fputs("random_mechanisms N [FIRST [FEATURES]]\n", stderr), 2;
  const std::uint64_t n = std::strtoull(words[1], nullptr, 10),
                      first = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
  const unsigned features =
      count > 3 ? static_cast<unsigned>(std::strtoul(words[3], nullptr, 10)) : all_features;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::map<std::string, std::uint64_t> aside, failures;
  std::uint64_t set_aside = 0, failed = 0, shorter = 0;
  double worst = 0;
  for (std::uint64_t seed = first; seed < first + n; ++seed) {
    const Mechanism mechanism = draw(seed, features);
    const Verdict verdict = judge(mechanism, seed);
    const std::string kind = verdict.why.substr(0, verdict.why.find(':'));
    if (verdict.kind == Verdict::Kind::agrees) {
      worst = std::max(worst, verdict.error);
      if (!verdict.why.empty()) ++shorter;
    }
    if (verdict.kind == Verdict::Kind::set_aside) ++set_aside, ++aside[kind];
    if (!verdict.failed()) continue;
    ++failures[kind];
    std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), verdict.why.c_str());
    if (failed++ > 0) continue;
    const std::string file = "random_" + std::to_string(seed) + ".toml";
    const Mechanism small = shrunk(mechanism, seed, verdict);
    std::ofstream(file) << "# Seed " << seed << ", shrunk: " << judge(small, seed).why << "\n"
                        << scene_text(small, 5, 0.005);
    std::printf("  the smallest that fails so is in %s\n", file.c_str());
  }
  std::printf(
      "%llu random mechanisms from seed %llu: %llu agree with the independent solver (largest error %.2g of "
      "what is allowed), %llu set aside, %llu failed\n",
      static_cast<unsigned long long>(n), static_cast<unsigned long long>(first),
      static_cast<unsigned long long>(n - set_aside - failed), worst,
      static_cast<unsigned long long>(set_aside), static_cast<unsigned long long>(failed));
  std::printf("  with shorter steps only: %llu\n", static_cast<unsigned long long>(shorter));
  for (const auto& [why, times] : aside)
    std::printf("  set aside, %s: %llu\n", why.c_str(), static_cast<unsigned long long>(times));
  for (const auto& [why, times] : failures)
    std::printf("  failed, %s: %llu\n", why.c_str(), static_cast<unsigned long long>(times));
  if (set_aside * 3 > n) std::printf("more than a third set aside: that proves little\n");
  return failed > 0 || set_aside * 3 > n ? 1 : 0;
}
