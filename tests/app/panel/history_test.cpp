// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "app/panel/document/edit_history.hpp"
#include "app/panel/document/param_rows.hpp"
#include "app/panel/view/playback.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

TEST_CASE("a document means what the command line with its edits means") {
  SceneDocument document = open_document("hoop6", {"solver.stages=2"});
  document.edits["solver.step"] = 0.02;
  document.edits["structure.mass"] = std::string("lumped");
  const Scene scene = read_document(document);
  CHECK(scene.solver.stages == 2);
  CHECK(scene.solver.step == 0.02);
  CHECK(scene.structure.text("mass") == "lumped");
  CHECK(base_scene(document).solver.step == 0.01);
  CHECK(command_line(document, "render", "my out") ==
        "unfurl render hoop6 -o 'my out' --set solver.stages=2 --set solver.step=0.02 --set "
        "'structure.mass=\"lumped\"'");
}

TEST_CASE("a word for a shell survives it") {
  CHECK(shell_word("a=1.5") == "a=1.5");
  CHECK(shell_word("") == "''");
  CHECK(shell_word("it's $HOME") == "'it'\\''s $HOME'");
}

TEST_CASE("a drag is one step of undo, redo brings it back, a new change forgets the redo") {
  EditHistory history(open_document("hoop6", {}));
  const SceneDocument start = history.now();
  for (const double x : {0.011, 0.012, 0.013}) history.edit("solver.step", x);
  history.end_gesture();
  history.edit("solver.step", 0.05);
  history.end_gesture();
  CHECK(history.undo());
  CHECK(std::get<double>(history.now().edits.at("solver.step")) == 0.013);
  CHECK(history.undo());
  CHECK(history.now() == start);
  CHECK_FALSE(history.undo());
  CHECK(history.redo());
  CHECK(std::get<double>(history.now().edits.at("solver.step")) == 0.013);
  history.edit("solver.stages", 4L);
  CHECK_FALSE(history.redo());
  history.forget("solver.step");
  CHECK_FALSE(history.now().edits.contains("solver.step"));
  CHECK(history.undo());
  CHECK(history.now().edits.contains("solver.step"));
}

TEST_CASE("what is typed and taken back leaves the redo as it was") {
  EditHistory history(open_document("hoop6", {}));
  const SceneDocument start = history.now();
  history.edit("solver.stages", 4L);
  CHECK(history.undo());
  for (const double x : {0.2, 0.25}) history.edit("solver.step", x);
  CHECK_FALSE(history.can_redo());
  history.take_back("solver.step");
  CHECK(history.now() == start);
  CHECK_FALSE(history.can_undo());
  CHECK(history.redo());
  CHECK(std::get<long>(history.now().edits.at("solver.stages")) == 4);
  // What is kept is a change, and forgets it.
  CHECK(history.undo());
  history.edit("solver.step", 0.2);
  history.end_gesture();
  history.edit("solver.step", 0.3);
  history.take_back("solver.step");
  CHECK(std::get<double>(history.now().edits.at("solver.step")) == 0.2);
  CHECK_FALSE(history.redo());
}

TEST_CASE("every declared parameter of a scene has a row, and its value is in the slider's range") {
  for (const LibraryScene& library_scene : library_scenes()) {
    INFO(library_scene.name);
    const Scene scene = base_scene(open_document(library_scene.path, {}));
    std::size_t rows = 0;
    for (const ParamSection& section : param_sections(scene)) {
      for (const ParamRow& row : section.rows) {
        INFO(row.key);
        ++rows;
        const bool given = !not_given(row.value);
        if (given) CHECK(range_error(row.spec, row.value).empty());
        if (row.spec.kind != ParamKind::real && row.spec.kind != ParamKind::integer) continue;
        const SliderRange range = slider_range(row);
        const double x = row.spec.kind == ParamKind::real ? std::get<double>(row.value)
                                                          : static_cast<double>(std::get<long>(row.value));
        CHECK(range.low < range.high);
        if (given) CHECK(range.low <= x);
        if (given) CHECK(x <= range.high);
        // Both ends are allowed: no slider leads into an error of its own.
        if (row.spec.kind == ParamKind::real) {
          CHECK(range_error(row.spec, range.low).empty());
          CHECK(range_error(row.spec, range.high).empty());
        }
      }
    }
    CHECK(rows >= solver_params().size() + render_params().size() + 2);  // and gravity, a structure
  }
}

TEST_CASE("playback loops, or stops at the end") {
  Playback p{0, 2, true, true};
  CHECK(advanced(p, 1, 0, 5).t == Approx(2));
  CHECK(advanced(p, 3, 0, 5).t == Approx(1));
  p.loop = false;
  CHECK(advanced(p, 3, 0, 5).t == 5);
  CHECK_FALSE(advanced(p, 3, 0, 5).playing);
  Playback ended{5, 1, false, false};
  CHECK(toggled(ended, 0, 5).t == 0);
  CHECK(toggled(ended, 0, 5).playing);
  // A span of nothing does not divide by zero.
  CHECK(advanced(Playback{1, 1, true, true}, 1, 1, 1).t == 1);
}
