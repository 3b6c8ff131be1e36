// SPDX-License-Identifier: BSD-3-Clause
// Slices, resuming and whose frames they are.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "render/image/png.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace film_test {

namespace {

// Five small frames of a short run.
std::vector<std::string> film(const std::string& out, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {
      "render", "hoop6_sector", "--set", "solver.end_time=0.2", "--size",  "96x64",
      "--fps",  "20",           "--set", "render.hold=0",       "--quiet", "--dpi",
      "60",     "-o",           out};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::size_t frames_in(const std::string& out) {
  std::error_code error;
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(out + "/frames", error), fs::directory_iterator()));
}

std::string frame(const std::string& out, int k) {
  return out + "/frames/frame_0000" + std::to_string(k) + ".png";
}

}  // namespace

TEST_CASE("slices share one film, and the last one makes the animations") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  CHECK(run_program(film(out, {"--frames", "0:2"})).code == 0);
  CHECK(frames_in(out) == 2);
  CHECK_FALSE(fs::exists(out + "/animation.gif"));
  CHECK(run_program(film(out, {"--frames", "4:9"})).code == 0);  // up to the film's end
  CHECK(frames_in(out) == 3);
  CHECK(run_program(film(out, {"--frames", "2:4"})).code == 0);
  CHECK(frames_in(out) == 5);
  CHECK(file_text(out + "/animation.gif").starts_with("GIF89a"));
  CHECK(fs::exists(out + "/animation.webp"));
}

// Their size is not that of the scene but of the motion, which is known when it is simulated.
TEST_CASE("frames of the motion's shape make films, and are found again") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--frames", "0:2"}, {}, {}}) {
    std::vector<std::string> words = film(out, more);
    words.push_back("--fit");
    const ProgramResult r = run_program(words);
    INFO(r.err);
    CHECK(r.code == 0);
  }
  CHECK(frames_in(out) == 5);
  CHECK(fs::exists(out + "/animation.webp"));
  const auto drawn = fs::last_write_time(frame(out, 3));
  std::vector<std::string> again = film(out, {"--fit"});
  CHECK(run_program(again).code == 0);
  CHECK(fs::last_write_time(frame(out, 3)) == drawn);
  const std::string mode = dir / "mode";
  CHECK(run_program({"render", "hoop6_sector", "--mode", "2", "--at", "4.1", "--set",
                     "structure.youngs_modulus=7e10", "--fps", "2", "--size", "96x64", "--fit", "--quiet",
                     "-o", mode})
            .code == 0);
  CHECK(fs::exists(mode + "/animation.webp"));
}

TEST_CASE("a plan is of the part that is asked for") {
  const ScratchDirectory dir;
  const auto plan = [&](std::vector<std::string> more) {
    more.emplace_back("--plan");
    const ProgramResult result = run_program(film(dir / "out", more));
    CHECK(result.code == 0);
    return result.out;
  };
  const auto has = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  const std::string whole = plan({}), part = plan({"--frames", "2:4"}), one = plan({"--frames", "3"}),
                    films = plan({"--encode-only"});
  CHECK(has(whole, "\n5 frames of 96 x 64\n"));
  CHECK(has(whole, "frame_00000.png"));
  CHECK(has(whole, "animation.gif"));
  CHECK(has(part, "\n2 frames of 96 x 64\n"));
  CHECK(has(part, "frame_00002.png"));
  CHECK_FALSE(has(part, "animation"));
  CHECK(has(one, "\n1 frame of 96 x 64\n"));
  CHECK(has(one, "frame_00003.png"));
  CHECK(has(films, "films of 5 frames"));
  CHECK(has(films, "animation.gif"));
  CHECK_FALSE(has(films, "frame_0"));
  CHECK_FALSE(has(films, "figures/\n"));
  CHECK(run_program(film(dir / "out", {"--plan", "--frames", "9"})).code == 2);
  CHECK_FALSE(fs::exists(dir / "out"));
}

TEST_CASE("data of the same motion leave its film alone, data of another replace it when told to") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  auto run = film(out, {"--export", "csv"});
  run[0] = "run";
  const auto dpi = std::find(run.begin(), run.end(), "--dpi");  // it draws no figures
  run.erase(dpi, dpi + 2);
  CHECK(run_program(run).code == 0);
  CHECK(fs::exists(out + "/csv/nodes.csv"));
  CHECK(frames_in(out) == 5);
  CHECK(fs::exists(out + "/animation.gif"));
  run[3] = "solver.end_time=0.3";
  const auto refused = run_program(run);
  CHECK(refused.code == 5);
  CHECK(refused.err.find("--force") != std::string::npos);
  CHECK(frames_in(out) == 5);
  run.emplace_back("--force");
  CHECK(run_program(run).code == 0);
  CHECK(frames_in(out) == 0);
  CHECK_FALSE(fs::exists(out + "/animation.gif"));
}

TEST_CASE("a second run draws only what is missing, and the same as before") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  const std::string lost = file_text(frame(out, 1)), cut = file_text(frame(out, 3));
  std::ofstream(frame(out, 0)) << file_text(frame(out, 4));  // a whole PNG, only not ours: must stay
  fs::remove(frame(out, 1));
  fs::resize_file(frame(out, 3), 100);  // as by a broken copy
  CHECK(run_program(film(out)).code == 0);
  CHECK(file_text(frame(out, 0)) == file_text(frame(out, 4)));
  CHECK(file_text(frame(out, 1)) == lost);
  CHECK(file_text(frame(out, 3)) == cut);
}

TEST_CASE("a frame with one wrong byte is found and drawn again, and the films with it") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  const std::string good = file_text(frame(out, 2));
  std::string bad = good;
  bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
  std::ofstream(frame(out, 2), std::ios::binary) << bad;
  CHECK(run_program(film(out)).code == 0);
  CHECK(file_text(frame(out, 2)) == good);
}

TEST_CASE("films that are missing or damaged are made again, those that are there are not") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  const std::string webp = file_text(out + "/animation.webp"), gif = file_text(out + "/animation.gif");
  const auto drawn = fs::last_write_time(out + "/animation.gif");
  fs::remove(out + "/animation.webp");
  CHECK(run_program(film(out)).code == 0);
  CHECK(file_text(out + "/animation.webp") == webp);
  CHECK(fs::last_write_time(out + "/animation.gif") == drawn);
  fs::resize_file(out + "/animation.gif", 100);
  CHECK(run_program(film(out)).code == 0);
  CHECK(file_text(out + "/animation.gif") == gif);
}

TEST_CASE("an MP4 that fails is exit 5 with the command by hand, and is made when ffmpeg is well again") {
  if (std::system("command -v ffmpeg > /dev/null") != 0) return;
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  dir.write("bin/ffmpeg", "#!/bin/sh\nexit 1\n");
  fs::permissions(dir / "bin/ffmpeg", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  const ProgramResult failed = run_program(film(out), {.environment = {"PATH=" + dir / "bin" + ":" + path}});
  CHECK(failed.code == 5);
  CHECK(failed.err.starts_with("unfurl: " + out + "/animation.mp4: no MP4 was written: ffmpeg "));
  CHECK(failed.err.find("by hand: ffmpeg -framerate 20 -i '" + out + "/frames/frame_%05d.png' -vf ") !=
        std::string::npos);
  CHECK(fs::exists(out + "/animation.webp"));  // what could be made is there
  CHECK(fs::exists(out + "/animation.gif"));
  CHECK(run_program(film(out)).code == 0);
  CHECK(fs::exists(out + "/animation.mp4"));
}

TEST_CASE("without ffmpeg there is no MP4, which is an error only for who asked for one") {
  const ScratchDirectory dir;
  fs::create_directories(dir / "empty");
  const ProgramOptions bare{.environment = {"PATH=" + dir / "empty"}};
  const ProgramResult quiet = run_program(film(dir / "out"), bare);
  CHECK(quiet.code == 0);
  CHECK(quiet.err == "");
  CHECK(fs::exists(dir / "out/animation.webp"));
  // Nor does a scene ask for it that the program wrote.
  CHECK(run_program({"render", dir / "out/scene.toml", "-o", dir / "again", "--quiet"}, bare).code == 0);
  const ProgramResult asked = run_program(film(dir / "out", {"--set", "render.mp4=true"}), bare);
  CHECK(asked.code == 5);
  CHECK(asked.err.find("no ffmpeg in the PATH") != std::string::npos);
  CHECK(run_program({"new", "hoop"}).out.find("\nmp4 = ") == std::string::npos);
  CHECK(run_program({"show", "hoop6", "--all", "--set", "render.mp4=true"}).out.find("\nmp4 = true\n") !=
        std::string::npos);
}

TEST_CASE("a record of a film that is nonsense is that of no film") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  for (const char* record :
       {R"({"fingerprint":5})", R"({"films":null})", "[1]", "nonsense", R"({"films":{"animation.gif":7}})"}) {
    dir.write("out/film.json", record);
    INFO(record);
    CHECK(run_program(film(out)).code == 5);
    CHECK(run_program(film(out, {"--force"})).code == 0);
  }
}

TEST_CASE("frames of another scene are never mixed in, and --force starts over") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  const std::string before = file_text(frame(out, 4));
  const auto changed = film(out, {"--set", "structure.hinge_force=400"});
  const ProgramResult r = run_program(changed);
  CHECK(r.code == 5);
  CHECK(r.err == "unfurl: " + out +
                     ": holds frames of another film (the scene, its settings or the program changed); use "
                     "--force to start over, or another -o\n");
  CHECK(file_text(frame(out, 4)) == before);
  auto forced = changed;
  forced.insert(forced.end(), {"--force", "--frames", "0:1"});
  CHECK(run_program(forced).code == 0);
  CHECK(frames_in(out) == 1);
  CHECK_FALSE(fs::exists(out + "/animation.gif"));
}

TEST_CASE("what changes no frame is no other film") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(film(out)).code == 0);
  const auto drawn = fs::last_write_time(frame(out, 2));
  const std::string gif = file_text(out + "/animation.gif");
  CHECK(run_program(film(out, {"--set", "render.gif_width=48"})).code == 0);
  CHECK(fs::last_write_time(frame(out, 2)) == drawn);
  CHECK(file_text(out + "/animation.gif").size() < gif.size());
}

TEST_CASE("the number of threads changes no byte of any picture or film") {
  const ScratchDirectory dir;
  REQUIRE(run_program(film(dir / "one", {"--threads", "1"})).code == 0);
  REQUIRE(run_program(film(dir / "four", {"--threads", "4"})).code == 0);
  for (int k = 0; k < 5; ++k) CHECK(file_text(frame(dir / "one", k)) == file_text(frame(dir / "four", k)));
  for (const char* name : {"/animation.webp", "/animation.gif", "/animation.mp4"})
    CHECK(file_text((dir / "one") + name) == file_text((dir / "four") + name));
}

TEST_CASE("options of pictures that are wrong say so") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  const auto error = [&](const std::vector<std::string>& more) { return run_program(film(out, more)); };
  CHECK(
      error({"--frames", "3-4"}).err ==
      "unfurl: --frames must be FIRST:END, two whole numbers (END itself is left out), or one; got '3-4'\n");
  CHECK(error({"--frames", "4:4"}).err == "unfurl: --frames 4:4 names no frame\n");
  CHECK(error({"--frames", "7:9"}).err ==
        "unfurl: --frames 7:9 begins behind the film's end: it has 5 frames, from 0\n");
  CHECK(error({"--look", "studyo"}).err.find("render.look") != std::string::npos);
  CHECK(error({"--set", "render.inset=deployed_fractoin"}).err.find("did you mean 'deployed_fraction'?") !=
        std::string::npos);
  CHECK(error({"--set", "render.trails=Q*"}).code == 3);
}

TEST_CASE("a poster is its poses side by side") {
  const ScratchDirectory dir;
  const std::vector<std::string> words = {
      "poster", "hoop6_sector", "--size", "192x96", "--quiet", "--poses", "4", "-o", dir / "p.png"};
  CHECK(run_program(words).code == 0);
  const Image whole = read_png(dir / "p.png");
  std::vector<std::string> bare = words;
  bare.insert(bare.end(), {"--set", "render.title=false", "--set", "render.legend=false"});
  CHECK(run_program(bare).code == 0);
  const Image poses = read_png(dir / "p.png");
  CHECK(poses.width == 4 * 64);
  CHECK(poses.height == 48);
  // The title and the legend are above, and change nothing below.
  CHECK(whole.width == 4 * 64);
  REQUIRE(whole.height > 48);
  CHECK(std::equal(poses.rgba.begin(), poses.rgba.end(), whole.rgba.end() - 4 * 4 * 64 * 48));
  CHECK(run_program({"poster", "hoop6_sector", "-o", dir / "p.jpg"}).err ==
        "unfurl: a poster is written as .png, not '.jpg'\n");
}

TEST_CASE("a poster has its scale bar and its axes once, in the first pose") {
  const ScratchDirectory dir;
  const auto poster = [&](const std::vector<std::string>& changes) {
    // So large that the bar has its room anyway: all that differs is what is drawn.
    std::vector<std::string> words = {"poster",  "pendulum", "--size", "1920x1080",  "--quiet",
                                      "--poses", "3",        "-o",     dir / "p.png"};
    for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
    REQUIRE(run_program(words).code == 0);
    return read_png(dir / "p.png");
  };
  const Image without = poster({}), with = poster({"render.scale_bar=true", "render.axes=true"});
  REQUIRE(with.rgba.size() == without.rgba.size());
  int last = -1;  // column that differs
  for (std::size_t i = 0; i < with.rgba.size(); ++i)
    if (with.rgba[i] != without.rgba[i]) last = std::max(last, static_cast<int>(i / 4) % with.width);
  CHECK(last >= 0);
  CHECK(last < 640);
}

TEST_CASE("a poster says what its colours stand for, and has one scale whatever camera keys do") {
  const ScratchDirectory dir;
  const auto poster = [&](const std::string& name, const std::vector<std::string>& changes) {
    std::vector<std::string> words = {"poster",  "hoop6_sector", "--size",
                                      "480x200", "--quiet",      "--poses",
                                      "2",       "-o",           dir / (name + ".png")};
    for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
    CHECK(run_program(words).code == 0);
    return file_text(dir / (name + ".png"));
  };
  const std::string by = "render.colour_by=axial_force";
  const auto width = [](const std::string& png) {
    return static_cast<unsigned char>(png.at(18)) * 256 + static_cast<unsigned char>(png.at(19));
  };
  CHECK(width(poster("with", {by})) == 3 * 160);  // two poses, and what colours stand for
  CHECK(width(poster("without", {by, "render.legend=false"})) == 2 * 160);
  const auto keys = [&](const std::string& last) {
    poster("keys",
           {"render.camera_keys=[{time=0, azimuth=-60, elevation=20, zoom=1}, {time=4, " + last + "}]"});
    return read_png(dir / "keys.png").rgba;  // the file has its scene in it, too
  };
  CHECK(keys("azimuth=-60, elevation=20, zoom=1") == keys("azimuth=10, elevation=50, zoom=3"));
}

TEST_CASE("a mode's film is whole periods of it, and is mixed with no other film") {
  const ScratchDirectory dir;
  const std::string out = dir / "mode";
  const auto mode = [&](const std::string& k, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"render",  "hoop6_sector",
                                      "--mode",  k,
                                      "--at",    "4.1",
                                      "--set",   "structure.youngs_modulus=7e10",
                                      "--fps",   "4",
                                      "--size",  "96x64",
                                      "--quiet", "-o",
                                      out};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  REQUIRE(mode("2").code == 0);
  REQUIRE(frames_in(out) == 24);     // three periods of two seconds
  const auto picture = [&](int k) {  // its pixels: each file has a receipt of its own
    return read_png(out + "/frames/frame_000" + std::string(k < 10 ? "0" : "") + std::to_string(k) + ".png")
        .rgba;
  };
  for (int k = 0; k < 8; ++k) {
    CAPTURE(k);
    CHECK(picture(k) == picture(k + 8));
    CHECK(picture(k) == picture(k + 16));
  }
  CHECK(picture(0) == picture(4));  // through the pose, both ways
  CHECK(picture(1) == picture(3));
  CHECK_FALSE(picture(2) == picture(6));  // the two ends
  CHECK_FALSE(picture(0) == picture(2));
  // Its length is not that of the scene's motion.
  CHECK(run_program({"render", "hoop6_sector", "--mode", "1", "--at", "start", "--set", "solver.end_time=5e4",
                     "--fps", "4", "--size", "96x64", "--quiet", "-o", dir / "long"})
            .code == 0);
  CHECK(frames_in(dir / "long") == 24);
  for (const char* file : {"modes.csv", "scene.toml", "animation.gif", "figures/modes.svg"})
    CHECK(fs::exists(out + "/" + file));
  CHECK(run_program({"verify", out}).code == 0);

  const ProgramResult other = mode("1");
  CHECK(other.code == 5);
  CHECK(other.err.find("--force") != std::string::npos);
  CHECK(mode("1", {"--force"}).code == 0);  // of the mechanism: it moves as its constraints let it
  CHECK_FALSE(picture(2) == picture(6));
}

TEST_CASE("modes that are not there, and what a mode's film has not, are refused in words") {
  const ScratchDirectory dir;
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"render", "pendulum", "-o", dir / "out"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult r = run_program(words);
    CHECK(r.code == 2);
    CHECK_FALSE(fs::exists(dir / "out"));
    return r.err;
  };
  CHECK(refused({"--mode", "9"}).find("--mode takes 1 to ") != std::string::npos);
  CHECK(refused({"--mode", "0"}).find("--mode") != std::string::npos);
  CHECK(refused({"--at", "0.5"}).find("--mode") != std::string::npos);
  CHECK(refused({"--mode", "1", "--plan"}).find("--plan") != std::string::npos);
  CHECK(refused({"--mode", "1", "--export", "vtk"}).find("--export") != std::string::npos);
  CHECK(refused({"--mode", "1", "--at", "soon"}).find("soon") != std::string::npos);
}

}  // namespace film_test
