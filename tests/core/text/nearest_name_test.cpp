// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/nearest_name.hpp"

#include <catch2/catch.hpp>

using namespace unfurl;

TEST_CASE("the nearest name is found by small slips") {
  const std::vector<std::string_view> known = {"post_length", "chord_rod_length", "density", "step"};
  CHECK(nearest_name("post_lenght", known) == "post_length");  // swapped
  CHECK(nearest_name("pos_length", known) == "post_length");   // left out
  CHECK(nearest_name("densitty", known) == "density");         // doubled
  CHECK(nearest_name("Density", known) == "density");          // case
  CHECK(nearest_name("stpe", known) == "step");
  CHECK(nearest_name("chord", known) == "chord_rod_length");  // beginning
}

TEST_CASE("what resembles nothing gets no suggestion but the list") {
  const std::vector<std::string_view> known = {"post_length", "density"};
  CHECK(nearest_name("gravity", known).empty());
  CHECK(nearest_name("", known).empty());
  // Three slips where a third of six letters are two: one put before, one changed, one behind.
  CHECK(nearest_name("abcdef", {"zabcdzfq"}).empty());
  CHECK(nearest_name("abcdef", {"zabcdefq"}) == "zabcdefq");
  CHECK(did_you_mean("gravity", known) == "; known: post_length, density");
  CHECK(did_you_mean("densty", known) == "; did you mean 'density'?");
  CHECK(did_you_mean("x", {}).empty());
}

TEST_CASE("a name in a message stays on its line") {
  CHECK(in_quotes("a\nb") == "'a\\x0ab'");
  CHECK(in_quotes(std::string(1000, 'x')).size() < 70);
}
