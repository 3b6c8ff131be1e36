// SPDX-License-Identifier: BSD-3-Clause
// Studies from the panel: the command line's code, beside the window.
#include <imgui_internal.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "core/scene/build.hpp"
#include "core/study/study.hpp"
#include "render/plot/ticks.hpp"
#include "tests/app/panel/panel_driver.hpp"

using namespace unfurl;

namespace study_pane_test {

namespace {

// Frames until the study that runs has ended and its outcome was taken.
void finish_study(PanelDriver& driver, const std::shared_ptr<const StudyOutcome>& before) {
  for (int i = 0; i < 20000 && driver.state().studied == before; ++i) {
    driver.frame(0, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  REQUIRE(driver.state().studied != before);
  for (int i = 0; i < 3; ++i) driver.frame(0);
}

// Of dvm alone, from the page's own button.
void study_dvm(PanelDriver& driver, double largest_step, double smallest_step) {
  driver.state().study.methods = {"dvm"};
  driver.state().study.largest_step = largest_step;
  driver.state().study.smallest_step = smallest_step;
  driver.click("start study");
  finish_study(driver, nullptr);
}

}  // namespace

TEST_CASE("the page of studies measures speed against accuracy of the scene that is shown") {
  PanelDriver driver(PanelDriver::small(), "four_bar");
  driver.click("page Studies");
  REQUIRE(driver.state().studies_open);
  driver.click("study method rk4");  // off: dvm alone
  REQUIRE(driver.state().study.methods == std::vector<std::string>{"dvm"});
  study_dvm(driver, 0.04, 0.02);
  const StudyOutcome& outcome = *driver.state().studied;
  INFO(outcome.message);
  REQUIRE(outcome.figures.size() == 1);
  CHECK(outcome.sentence.starts_with("The cheapest setting for 0.001 m is dvm"));
  CHECK(driver.panel().has_place("study figure"));
  // The errors (not the times) are those of the command line's study.
  const Scene scene = read_document(driver.state().history.now());
  StudyPlan plan = plan_study(build_model(scene), scene.solver, 0.04, 0.02, {});
  keep_methods(plan, {"dvm"});
  plan.timing = {1, 0, 10};
  Journal journal({}, study_columns(), study_key_columns);
  const Study study = run_study(plan, journal, {});
  const Curve& curve = outcome.figures[0].panels.at(0).curves.at(0);
  CHECK(curve.label == study.curves.at(0).setting.name);
  REQUIRE(curve.y.size() == study.curves[0].runs.size());
  for (std::size_t i = 0; i < curve.y.size(); ++i)
    CHECK(curve.y[i] == study.curves[0].runs[i].position_error);
}

TEST_CASE("the present run is on the study's figure of its motion, and moves as settings are changed") {
  PanelDriver driver(PanelDriver::small(), "four_bar");
  driver.key(Key::three);
  study_dvm(driver, 0.05, 0.025);
  const StudyOutcome& outcome = *driver.state().studied;
  REQUIRE(outcome.study);
  const auto now_of = [&](const Figure& figure) {
    std::vector<Curve> found;
    for (const Curve& curve : figure.panels.at(0).curves)
      if (curve.label == "now") found.push_back(curve);
    return found;
  };
  FigureCards cards;
  const auto shown = [&] {
    const PanelState& state = driver.state();
    return *cards.study(state.studied, state.trade, state.trade_news, 200).at(0)->figure;
  };
  const TradePoint before = driver.state().trade.back();
  REQUIRE(before.accuracy == Accuracy::known);
  REQUIRE(now_of(shown()).size() == 1);
  CHECK(now_of(shown())[0].x.at(0) == before.cpu_s);
  CHECK(now_of(shown())[0].y.at(0) == before.position_error);
  // The panel's steps of 0.05 s are not the study's; but a run with the study's own step has its error, whose
  // largest value is at the end of both.
  const StudyCurve& curve = outcome.study->curves.at(1);
  driver.state().history.edit("solver.stages", static_cast<long>(curve.setting.options.stages));
  driver.state().history.edit("solver.step", curve.runs.at(0).step);
  driver.settle();
  const TradePoint after = driver.state().trade.back();
  CHECK(now_of(shown())[0].y.at(0) == after.position_error);
  CHECK(after.position_error != before.position_error);
  CHECK(after.position_error >= 0.99 * curve.runs[0].position_error);
  // The trade's own card has the study's curves behind its points, in the same place.
  const Figure trade = trade_figure(driver.state().trade, outcome.study.get());
  CHECK(trade.panels.at(0).curves.at(1).y.at(0) == curve.runs[0].position_error);
  // Of another motion neither knows anything.
  driver.state().history.edit("gravity.acceleration", std::vector<double>{0, 0, -5});
  driver.settle();
  CHECK(now_of(shown()).empty());
}

TEST_CASE("a measure over a parameter comes to the page, and bad values say why") {
  PanelDriver driver;
  driver.key(Key::three);
  driver.state().study.kind = StudyRequest::Kind::sweep;
  driver.state().study.key = "structure.fold_angle";
  driver.state().study.from = 50;
  driver.state().study.to = 80;
  driver.state().study.count = 3;
  driver.frame();
  driver.click("start study");
  finish_study(driver, nullptr);
  const auto first = driver.state().studied;
  REQUIRE(first->figures.size() == 1);
  const Curve& curve = first->figures[0].panels.at(0).curves.at(0);
  CHECK(curve.x == std::vector<double>{50, 65, 80});
  CHECK(curve.y[0] < curve.y[2]);  // what is folded less is open sooner
  CHECK(first->sentence == "deployment time (s): from " + plot::format_number(curve.y[0], 4) +
                               " (at 50) to " + plot::format_number(curve.y[2], 4) + " (at 80).");
  driver.state().study.to = 95;  // the ring folds by less than 90 degrees
  driver.frame();
  driver.click("start study");
  finish_study(driver, first);
  CHECK(driver.state().studied->message.find("fold_angle") != std::string::npos);
}

TEST_CASE("a parameter without a value is studied about a usual one") {
  PanelDriver driver;
  driver.key(Key::three);
  driver.state().study.kind = StudyRequest::Kind::sweep;
  driver.frame();
  for (const std::string key :
       {"structure.youngs_modulus", "structure.strength", "structure.chord_rod_length"}) {
    CAPTURE(key);
    driver.click("study key");
    driver.click("study key=" + key);
    const StudyRequest& study = driver.state().study;
    CHECK(study.key == key);
    CHECK(std::isfinite(study.to));
    CHECK(study.from > 0);
    CHECK(study.from < study.to);
  }
}

TEST_CASE("a tooltip at the window's edge is whole") {
  PanelDriver driver;
  driver.key(Key::three);
  driver.state().study.kind = StudyRequest::Kind::sweep;
  driver.frame();
  driver.move_to("copy study");
  for (int i = 0; i < 3; ++i) driver.frame();
  const ImGuiWindow* tooltip = nullptr;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Active && (window->Flags & ImGuiWindowFlags_Tooltip) != 0) tooltip = window;
  REQUIRE(tooltip);
  CHECK(tooltip->Pos.x >= 0);
  CHECK(tooltip->Pos.x + tooltip->Size.x <= 1000);
}

// 1.5 m g at the lowest point, whatever its length (for a rod of 5 kg without a bob 73.6 N): not the column
// behind it, which says whether that is unique.
TEST_CASE("the sentence of a measure that may not be unique is of the measure itself") {
  PanelDriver driver(PanelDriver::small(), "pendulum");
  driver.state().history.edit("structure.rod_mass", 5.0);
  driver.state().history.edit("structure.bob_mass", 0.0);
  driver.settle();
  driver.key(Key::three);
  driver.state().study.kind = StudyRequest::Kind::sweep;
  driver.state().study.key = "structure.length";
  driver.state().study.measure = "peak_rod_force";
  driver.state().study.from = 0.5;
  driver.state().study.to = 1.5;
  driver.state().study.count = 3;
  driver.frame();
  driver.click("start study");
  finish_study(driver, nullptr);
  const std::string words = "peak rod force (N): from 73.5";
  CHECK(driver.state().studied->sentence.substr(0, words.size()) == words);
}

TEST_CASE("a study is cancelled at once, and the window does not wait for it") {
  PanelDriver driver;
  driver.key(Key::three);
  driver.state().study.methods = {"dvm", "rk4"};
  driver.state().study.largest_step = 0.01;
  driver.state().study.smallest_step = 1e-5;  // hours
  driver.frame();
  driver.click("start study");
  driver.frame();
  REQUIRE(driver.panel().has_place("cancel study"));
  CHECK(driver.panel().has_place("study progress"));
  driver.click("cancel study");
  finish_study(driver, nullptr);
  CHECK(driver.panel().has_place("start study"));
}

TEST_CASE("what is typed into a study's numbers is the whole of it") {
  PanelDriver driver(PanelDriver::small(), "pendulum");
  driver.state().study.kind = StudyRequest::Kind::sweep;
  driver.click("page Studies");
  const auto typed = [&](const std::string& text) {
    driver.click("study from");
    for (const char letter : text) driver.type(std::string(1, letter));
    driver.frame();
    driver.key(Key::enter);
    return driver.state().study.from;
  };
  CHECK(typed("1/8") == 0.125);
  CHECK(typed("1,5") == 1.5);
  CHECK(typed("150 cm") == 1.5);  // no number: as it was
  CHECK(driver.state().message.find("'150 cm' is no number") != std::string::npos);
}

TEST_CASE("the command of a study is what a person would type") {
  SceneDocument document = open_document("hoop6", {});
  document.edits["structure.units"] = 8L;
  StudyRequest request;
  request.methods = {"dvm", "rk4"};
  request.largest_step = 0.04;
  request.smallest_step = 0.0025;
  CHECK(study_command(request, document) ==
        "unfurl study hoop6 -o study --set structure.units=8 --steps 0.04:0.0025 --methods dvm,rk4");
  request.kind = StudyRequest::Kind::sweep;
  request.key = "structure.fold_angle";
  request.from = 50.0;
  request.to = 80.5;
  CHECK(study_command(request, document)
            .find("--vary structure.fold_angle=50.0:80.5:9 --measure deploy_time") != std::string::npos);
}

}  // namespace study_pane_test
