// SPDX-License-Identifier: BSD-3-Clause
// What has to be painted again, found from Dear ImGui's own lists.
#include "render/ui/draw_damage.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace unfurl;

namespace draw_damage_test {

namespace {

// Two windows side by side with a box each, and a third that is there or not.
class Screen {
 public:
  Screen() : context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {400, 300};
    io.DeltaTime = 0.01f;
    io.Fonts->Build();
  }
  ~Screen() { ImGui::DestroyContext(context_); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  std::vector<plot::Rect> draw(float left_at, float right_at, bool third = false) {
    ImGui::NewFrame();
    window("left", 0, left_at);
    window("right", 200, right_at);
    if (third) window("third", 100, 120);
    ImGui::Render();
    return damage_.update(*ImGui::GetDrawData());
  }

 private:
  static void window(const char* name, float x, float box) {
    ImGui::SetNextWindowPos({x, 0});
    ImGui::SetNextWindowSize({200, 300});
    ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground);
    ImGui::GetWindowDrawList()->AddRectFilled({x + 20, box}, {x + 40, box + 10}, 0xFFFFFFFF);
    ImGui::End();
  }
  ImGuiContext* context_;
  DrawDamage damage_;
};

}  // namespace

TEST_CASE("only where a window's contents moved is there something to paint") {
  Screen screen;
  CHECK(screen.draw(50, 50).size() == 1);  // all of it, at first
  screen.draw(50, 50);                     // new windows settle
  CHECK(screen.draw(50, 50).empty());
  const auto moved = screen.draw(50, 80);
  REQUIRE_FALSE(moved.empty());
  for (const plot::Rect& r : moved) {  // the box's old place and its new one, and a pixel around
    CHECK(r.x0 >= 218);
    CHECK(r.x1 <= 242);
    CHECK(r.y0 >= 48);
    CHECK(r.y1 <= 92);
  }
  const auto covers = [](const std::vector<plot::Rect>& rects, const plot::Rect& all) {
    return std::any_of(rects.begin(), rects.end(), [&](const plot::Rect& r) { return r.contains(all); });
  };
  screen.draw(50, 80, true);
  screen.draw(50, 80, true);
  CHECK(covers(screen.draw(50, 80), {120, 120, 140, 130}));  // what a closed window covered
}

TEST_CASE("rectangles that overlap become one where that is hardly larger, however they hang together") {
  CHECK(apart({{0, 0, 1, 1}, {2, 2, 3, 3}, {5, 5, 5, 9}}).size() == 2);  // one of them is empty
  const auto one = apart({{0, 0, 4, 1}, {6, 0, 9, 1}, {3, 0, 7, 1}});
  REQUIRE(one.size() == 1);
  CHECK(one[0].x0 == 0);
  CHECK(one[0].x1 == 9);
}

// A bar along the top and one along the side meet in a corner: what neither covers is not painted.
TEST_CASE("rectangles apart cover the pixels of those that overlapped, each once, and the last is whole") {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    constexpr int side = 24;
    std::vector<plot::Rect> rects;
    for (int i = 0; i < 5; ++i) {
      const auto at = [&] { return static_cast<double>(random() % side); };
      const double x = at(), y = at();
      rects.push_back({x, y, std::min<double>(side, x + at()), std::min<double>(side, y + at())});
    }
    const plot::Rect last{5, 6, 14, 13};
    rects.push_back(last);
    const std::vector<plot::Rect> parts = apart(rects);
    double wanted = 0, covered = 0;
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y) {
        const plot::Rect pixel{x + 0.0, y + 0.0, x + 1.0, y + 1.0};
        const auto over = [&](const plot::Rect& r) { return r.overlaps(pixel); };
        const auto times = std::count_if(parts.begin(), parts.end(), over);
        const bool asked = std::any_of(rects.begin(), rects.end(), over);
        wanted += asked;
        covered += static_cast<double>(times);
        CHECK(times <= 1);
        if (asked) CHECK(times == 1);
      }
    CHECK(covered <= 1.6 * wanted);  // joined at most a few times, each at most a tenth larger
    CHECK(std::any_of(parts.begin(), parts.end(), [&](const plot::Rect& r) { return r.contains(last); }));
  }
}

}  // namespace draw_damage_test
