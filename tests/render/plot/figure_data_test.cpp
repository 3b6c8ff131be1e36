// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figure_data.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/export/atomic_file.hpp"

namespace unfurl {
namespace {

Figure small() {
  Figure f;
  f.title = "Title";
  f.caption = "Caption.";
  f.panels.resize(1);
  Panel& p = f.panels[0];
  p.x.label = "time (s)", p.y.label = "force (N), tension > 0", p.y2.label = "fraction";
  Curve c;
  c.x = {0, 0.1}, c.y = {1.0 / 3, std::nan("")};
  p.curves.push_back(c);
  c.label = "a \"quoted\" one", c.right_axis = true;
  p.curves.push_back(c);
  p.bands.push_back({"b", {2}, {3}, {4}, 0});
  p.lines.push_back({5, true, "level", 7});
  p.lines.push_back({6, false, "", 7});
  p.segments.push_back({1, 2, 3, 4});
  p.cells.push_back({0, 1, 2, 3, {}, "right"});
  p.cells.push_back({2, 1, 4, 3, {}});  // of a colour bar: nothing to tell
  return f;
}

}  // namespace

TEST_CASE("the table of a figure has every number drawn, in full precision", "[figure]") {
  CHECK(figure_csv(small()) ==
        "panel,kind,series,x,y,x_end,y_end\n"
        "1,x_axis,time (s),,,,\n"
        "1,y_axis,\"force (N), tension > 0\",,,,\n"
        "1,right_axis,fraction,,,,\n"
        "1,cell,right,0,1,2,3\n"
        "1,curve,\"force (N), tension > 0\",0,0.3333333333333333,,\n"
        "1,curve,\"force (N), tension > 0\",0.1,,,\n"
        "1,right_curve,\"a \"\"quoted\"\" one\",0,0.3333333333333333,,\n"
        "1,right_curve,\"a \"\"quoted\"\" one\",0.1,,,\n"
        "1,band,b,2,3,,4\n"
        "1,line,level,,5,,\n"
        "1,line,,6,,,\n"
        "1,rod,,1,2,3,4\n");
  CHECK(figure_caption(small()) == "Title. Caption.\n");
}

TEST_CASE("the numbers of a figure stand beside it and never replace other data", "[figure]") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("unfurl_data_" + std::to_string(getpid()));
  fs::create_directories(folder);
  write_figure_data(small(), folder / "f.png");
  write_figure_data(small(), folder / "f.png");  // our own may be replaced
  CHECK(fs::exists(folder / "f.csv"));
  CHECK(fs::exists(folder / "f.caption.txt"));
  std::ofstream(folder / "series.csv") << "t_s,work_J\n0,0\n";
  CHECK_THROWS_AS(write_figure_data(small(), folder / "series.svg"), FileError);
  std::ofstream(folder / "mine.caption.txt") << "not of a figure\n";
  CHECK_THROWS_AS(write_figure_data(small(), folder / "mine.svg"), FileError);
  CHECK_FALSE(fs::exists(folder / "mine.csv"));
  fs::remove_all(folder);
}

}  // namespace unfurl
