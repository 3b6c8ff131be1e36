// SPDX-License-Identifier: BSD-3-Clause
// What the program says and returns for every kind of command line. Error texts are part of the contract.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace command_line_test {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void check_error(const std::vector<std::string>& arguments, int code, const std::string& message) {
  const ProgramResult r = run_program(arguments);
  INFO(r.err);
  CHECK(r.code == code);
  CHECK(r.out == "");
  CHECK(r.err == message + "\n");
}

}  // namespace

TEST_CASE("help and version go to standard output") {
  CHECK(contains(run_program({"--help"}).out, "unfurl run SCENE -o DIR"));
  CHECK(run_program({"--help"}).code == 0);
  CHECK(contains(run_program({"run", "--help"}).out, "usage: unfurl run SCENE -o DIR [options]"));
  CHECK(run_program({"help", "run"}).out == run_program({"run", "--help"}).out);
  check_error({"help", "rn"}, 2, "unfurl: no command 'rn'; did you mean 'run'?");
  CHECK(run_program({"--version"}).out == "unfurl 0.1.0\n");
}

TEST_CASE("a command line without a command shows the help and fails") {
  CHECK(run_program({}).code == 2);
  CHECK(contains(run_program({}).err, "usage:"));
}

TEST_CASE("usage errors") {
  check_error({"rn"}, 2, "unfurl: no command 'rn'; did you mean 'run'?");
  check_error({"run", "hoop6", "--forse", "-o", "x"}, 2,
              "unfurl: unfurl run has no option '--forse'; did you mean '--force'?");
  check_error({"run", "hoop6", "--banana", "3"}, 2,
              "unfurl: unfurl run has no option '--banana'; unfurl help run lists its options");
  check_error({"run", "hoop6", "--betwen", "3"}, 2,
              "unfurl: unfurl run has no option '--betwen'; unfurl help run lists its options");
  check_error({"run", "hoop6", "-o"}, 2, "unfurl: -o needs a value behind it");
  check_error({"run", "hoop6", "-o", "--quiet"}, 2, "unfurl: -o needs a value behind it, not --quiet");
  check_error({"run", "hoop6", "--output", "-o"}, 2, "unfurl: -o needs a value behind it, not -o");
  check_error({"run", "hoop6", "--set", "--json"}, 2, "unfurl: --set needs a value behind it, not --json");
  check_error({"run", "hoop6", "-o", "x", "--set"}, 2, "unfurl: --set needs a value behind it");
  check_error({"figure", "hoop6", "energy", "-o", "x.png", "--dpi", "1e9"}, 2,
              "unfurl: --dpi: must be a number from 20 to 2400; got '1e9'");
  check_error({"check", "hoop6", "--threads", "1.5"}, 2,
              "unfurl: --threads: must be a whole number from 1 to 1024; got '1.5'");
  check_error({"view", "hoop6", "--picture", "x.jpg"}, 2,
              "unfurl: a picture of the window is written as .png, not '.jpg'");
  check_error({"check", "hoop6", "--frames", "0:2"}, 2,
              "unfurl: unfurl check has no option '--frames'; unfurl render has it");
  check_error({"check", "hoop6", "-o", "x"}, 2, "unfurl: unfurl check has no option '-o'");
  check_error({"sweep", "hoop6", "--plan"}, 2,
              "unfurl: unfurl sweep has no option '--plan'; unfurl run and unfurl render have it");
  // By the option's own name, which is all that was typed.
  for (const char* size : {"640X360", "640,360", "640", "0x0", "640x", "x360", "6x4x3", "[640, 360]"})
    check_error({"render", "hoop6", "-o", "x", "--size", size}, 2,
                "unfurl: --size is WxH, two whole numbers of pixels, such as 1280x720; got '" +
                    std::string(size) + "'");
  check_error({"run", "hoop6"}, 2, "unfurl: -o DIR is missing (or --json, for the summary alone)");
  for (const char* verb : {"modes", "margin"})
    for (const std::vector<std::string>& idle : {std::vector<std::string>{"--style", "slide"},
                                                 {"--font", "helvetica"},
                                                 {"--dpi", "300"},
                                                 {"--force"}}) {
      std::vector<std::string> words{verb, "four_bar"};
      words.insert(words.end(), idle.begin(), idle.end());
      check_error(words, 2, "unfurl: " + idle[0] + " needs -o DIR: without it no files are written");
    }
  for (const char* idle : {"--force", "--resume"})
    check_error({"run", "four_bar", "--json", idle}, 2,
                "unfurl: " + std::string(idle) + " needs -o DIR: without it no files are written");
  check_error({"run"}, 2, "unfurl: too few arguments; usage: unfurl run SCENE -o DIR");
  check_error({"check", "hoop6", "hoop12"}, 2,
              "unfurl: unexpected argument 'hoop12'; usage: unfurl check SCENE");
  check_error({"--quiet", "run"}, 2, "unfurl: a command comes first, then its options; see unfurl --help");
  check_error({"list", "method"}, 2, "unfurl: no list 'method'; did you mean 'methods'?");
  CHECK(contains(run_program({"list", "foo"}).err, ", ...; unfurl help list tells all"));
  CHECK(run_program({"run", "hoop6", "--threads", "0"}).code == 2);
  CHECK(run_program({"run", "hoop6", "--threads", "many"}).code == 2);
}

// A pipe can be read once.
TEST_CASE("a scene from a pipe is shown, swept and solved as one from a file") {
  const ScratchDirectory dir;
  const std::string path =
      dir.write("s.toml",
                "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], "
                "fixed = true}, {name = 'B', position = [0.6, 0, 0.8]}]\nrods = [{nodes = "
                "['A', 'B'], mass = 1.3}]\n[solver]\nend_time = 0.05\nstep = 0.01\n");
  const auto ends = [&](const std::string& words) {
    return std::system(("cat '" + path + "' | " UNFURL_PROGRAM " " + words + " 2>'" + (dir / "err") + "' >'" +
                        (dir / "out") + "'")
                           .c_str());
  };
  CHECK(ends("show /dev/stdin") == 0);
  CHECK(file_text(dir / "out") == file_text(path));
  CHECK(ends("show /dev/stdin --set solver.step=0.02") == 0);
  CHECK(file_text(dir / "out").find("step = 0.02") != std::string::npos);
  CHECK(ends("solve /dev/stdin --find solver.end_time --target end_time=0.07") == 0);
  CHECK(file_text(dir / "out").starts_with("solver.end_time = 0.07"));
  CHECK(ends("sweep /dev/stdin --vary solver.end_time=0.02,0.03 --measure end_time -o '" + (dir / "sweep") +
             "'") == 0);
  CHECK(file_text(dir / "sweep/sweep.csv").find("0.03,completed,0.03") != std::string::npos);
}

TEST_CASE("invalid scenes") {
  check_error({"check", "hoop6", "--set", "structure.units=2"}, 3,
              "--set structure.units: must be a whole number in [3, 100000]; got 2");
  check_error({"check", "hoop6", "--set", "solver.step=0"}, 3, "--set solver.step: must be > 0 s; got 0");
  check_error(
      {"check", "hoop6", "--set", "solver.method=dvn"}, 3,
      "--set solver.method: must be one of dvm, rk4, rk4_baumgarte, rk4_projected, generalized_alpha; "
      "got 'dvn'; did you mean 'dvm'?");
  check_error({"check", "hoop6", "--set", "structure.post_length=-1", "--set", "solver.stpe=1"}, 3,
              "--set structure.post_length: must be > 0 m; got -1\n"
              "--set solver.stpe: unknown key; did you mean 'step'?");
  const ScratchDirectory dir;
  const auto path = dir.write("bad.toml", "[structure]\nkind = 'hoop'\ndensity = nan\n");
  check_error({"check", path}, 3,
              path + ":3:11: structure.density: must be a finite number > 0 kg/m^3; got nan");
  check_error({"check", dir.write("odd.toml", "[$")}, 3,
              dir / "odd.toml" + ":1:2: not TOML: unexpected character here");
}

TEST_CASE("a short option with an equals sign is no directory of that name") {
  check_error({"run", "pendulum", "-o=DD"}, 2,
              "unfurl: a short option takes its value behind a space: -o DD");
}

TEST_CASE("scenes that are not there") {
  check_error({"check", "hoop7"}, 5,
              "unfurl: no scene 'hoop7', neither a file nor a built-in one; did you mean 'hoop6'?");
  check_error({"check", "no/such.toml"}, 5, "unfurl: cannot read scene no/such.toml: no such file");
}

TEST_CASE("check counts the six-unit ring and names its redundant constraints") {
  const ProgramResult r = run_program({"check", "hoop6", "--json"});
  REQUIRE(r.code == 0);
  const auto json = nlohmann::json::parse(r.out);
  CHECK(json["coordinates"] == 72);
  CHECK(json["constraints"] == 78);
  CHECK(json["rank"] == 71);
  CHECK(json["redundant"].size() == 7);
  CHECK(json["self_stress"].size() == 7);
  CHECK(json["unique_rods"] == 6);
  CHECK(json["not_unique"].size() == 78 - 6 - 12);  // all but the posts and the twelve face rows
  CHECK(json["degrees_of_freedom"] == 1);
  // The rods of a face cross in the middle of an X, in one plane: tubes of 9 cm^2 are inside each other
  // there.
  const auto& near = json["clearance"];
  CHECK(near["axes_m"].get<double>() < 1e-9);
  CHECK(near["distance_m"].get<double>() == Approx(-2 * std::sqrt(9e-4 / 3.14159265358979)).epsilon(1e-6));
  CHECK(near["overlapping_pairs"].get<int>() >= 12);  // both faces of each sector
  CHECK(near["rods"].size() == 2);
  CHECK(near["whole_motion"] == true);
  CHECK(near["until_s"].get<double>() > 4.9);
  const std::string text = run_program({"check", "hoop6"}).out;
  CHECK(contains(text, "\nsmallest clearance"));
  CHECK(contains(text, "rank                          71\n"));
  for (const auto& name : json["redundant"])
    CHECK(contains(text, "\n  " + name.get<std::string>() + " against "));
}

TEST_CASE("check says first what matters, and of many redundant members the first names") {
  const std::vector<std::string> scene{"check", "hoop6", "--set", "structure.units=40"};
  const ProgramResult r = run_program(scene);
  const std::size_t title = r.out.find('\n'), freedom = r.out.find("degrees of freedom             1\n"),
                    redundant = r.out.find("redundant                     41\n"),
                    nodes = r.out.find("\nnodes"), listed = r.out.find(" against ");
  INFO(r.out);
  CHECK(freedom == title + 1);
  CHECK(freedom < redundant);
  CHECK(redundant < nodes);
  CHECK(nodes < listed);
  CHECK(std::count(r.out.begin(), r.out.end(), '\n') < 30);
  CHECK(r.out.ends_with("  and 33 more: --json lists all\n"));
  auto words = scene;
  words.emplace_back("--json");
  CHECK(nlohmann::json::parse(run_program(words).out)["redundant"].size() == 41);
}

TEST_CASE("margin: drives against resistances by source, in words, JSON and files") {
  const ScratchDirectory dir;
  const std::vector<std::string> scene{
      "margin", "hoop6",
      "--set",  "structure.fold_angle=60",
      "--set",  R"(forces=[{kind="torsion_spring",name="hose",fold_angle=true,stiffness=500}])"};
  auto words = scene;
  for (const char* word : {"--json", "--stuck", "--factor", "hose=1.5", "-o"}) words.emplace_back(word);
  words.push_back(dir / "margin");
  const ProgramResult r = run_program(words);
  REQUIRE(r.code == 0);
  const auto json = nlohmann::json::parse(r.out);
  // 12 hinges of 200 N on rods of 3 m, against 1.5 x 500 N m/rad over 60 degrees, deployed.
  const double pi = 3.14159265358979;
  CHECK(json["static_margin_min"].get<double>() == Approx(12 * 200 * 3 / (750 * pi / 3) - 1).epsilon(1e-8));
  CHECK(std::abs(json["static_margin_at"].get<double>()) < 1e-4);
  // 12 f l sin(60 deg) over half of 750 (pi / 3)^2.
  CHECK(json["dynamic_margin_min"].get<double>() ==
        Approx(12 * 200 * 3 * std::sin(pi / 3) / (375 * pi * pi / 9) - 1).epsilon(1e-6));
  CHECK(json["sources"].size() == 2);
  CHECK(json["sources"][1]["name"] == "hose");
  CHECK(json["sources"][1]["factor"] == 1.5);
  CHECK(json["arrives"] == true);
  CHECK_FALSE(json["stuck"].empty());
  for (const char* file :
       {"margin.csv", "motion.csv", "stuck.csv", "margin.json", "figures/margin.pdf", "figures/margin.png"})
    CHECK(std::filesystem::exists(dir / "margin" + "/" + file));
  const ProgramResult text = run_program(scene);
  CHECK(contains(text.out, "hoop6: static margin "));
  CHECK(contains(text.out, "the motion arrives"));
  const ProgramResult latched = run_program({"margin", "hoop6", "--json", "--set", "structure.fold_angle=60",
                                             "--set", "solver.at_deployed=latch", "-o", dir / "latched"});
  REQUIRE(latched.code == 0);
  const auto loads = nlohmann::json::parse(latched.out)["loads"];
  REQUIRE(loads.size() == 2);
  // All 12 hinges about the fold angle, then one of them by its own height: 12 f l, and f.
  CHECK(loads[0]["kind"] == "latch");
  CHECK(loads[0]["load"].get<double>() == Approx(12 * 200 * 3).epsilon(1e-8));
  CHECK(loads[0]["load_unit"] == "N m");
  CHECK(loads[0]["energy_J"].get<double>() == Approx(12 * 200 * 3 * std::sin(pi / 3)).epsilon(1e-6));
  CHECK(loads[1]["load"].get<double>() == Approx(200).epsilon(1e-8));
  CHECK(loads[1]["load_unit"] == "N");
  CHECK(contains(file_text(dir / "latched" + "/loads.csv"), "name,kind,fold_angle_deg,load,load_unit,speed"));
  CHECK(contains(file_text(dir / "latched" + "/figures/margin.caption.txt"),
                 "7200 N m at rest, and is met at"));
  CHECK(contains(run_program({"margin", "hoop6", "--set", "solver.at_deployed=latch"}).out, "stop or latch"));
  const ProgramResult full = run_program({"margin", "hoop6", "--set", "solver.model=full"});
  CHECK(full.code == 0);
  CHECK(contains(full.err, "--set solver.model=full does nothing: margins are those of the path"));
  const ProgramResult chain = run_program({"margin", "chain"});
  CHECK(chain.code == 3);
  CHECK(contains(chain.err, "no margin: the structure has 32 degrees of freedom"));
  const ProgramResult unknown = run_program({"margin", "hoop6", "--factor", "wind=2"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "nothing that acts is called 'wind'"));
  CHECK(run_program({"margin", "hoop6", "--factor", "loads"}).code == 2);
  // Of more units than rounding lets the whole's path be followed: by one of its sectors, and as much more of
  // each source as there are more of them. Not of hinges that jam one by one.
  double torque[2] = {};
  for (const int units : {8, 16}) {
    const ProgramResult ring = run_program({"margin", "hoop6", "--json", "--set", "structure.fold_angle=60",
                                            "--set", "structure.units=" + std::to_string(units)});
    REQUIRE(ring.code == 0);
    torque[units == 16] = nlohmann::json::parse(ring.out)["sources"][0]["largest_drive"].get<double>();
  }
  CHECK(torque[1] == Approx(2 * torque[0]).epsilon(1e-9));
  const ProgramResult jams = run_program(
      {"margin", "hoop6", "--stuck", "--set", "structure.fold_angle=60", "--set", "structure.units=30"});
  CHECK(jams.code == 3);
  CHECK(contains(jams.err, "the path cannot be followed to a deployed pose, no further than to 0.0"));
}

TEST_CASE("solver.model: the summary says what was solved and why, and path refuses what it cannot") {
  const auto model_of = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{"run"};
    words.insert(words.end(), more.begin(), more.end());
    words.emplace_back("--json");
    const ProgramResult r = run_program(words);
    INFO(r.err);
    REQUIRE(r.code == 0);
    return nlohmann::json::parse(r.out)["model"];
  };
  const std::string short_run = "solver.end_time=0.1";
  CHECK(model_of({"hoop6", "--set", short_run})["solved_as"] == "full");
  CHECK(model_of({"hoop6_sector", "--set", short_run})["solved_as"] == "sector");
  const auto path = model_of({"hoop6_sector", "--set", short_run, "--set", "solver.model=path"});
  CHECK(path["solved_as"] == "path");
  CHECK(contains(path["why"], "one degree of freedom"));
  const auto chain = model_of({"chain", "--set", short_run, "--set", "solver.model=auto"});
  CHECK(chain["solved_as"] == "full");
  CHECK(contains(chain["why"], "32 degrees of freedom"));
  const ProgramResult refused = run_program({"run", "chain", "--set", "solver.model=path", "--json"});
  INFO(refused.err);
  CHECK(refused.code == 3);
  CHECK(contains(refused.err, "solver.model = \"path\""));
}

TEST_CASE("modes: the mechanism's own first, then those of elastic rods, a modulus makes forces unique") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program({"modes", "hoop6", "--set", "structure.youngs_modulus=7e10", "--set",
                                       "structure.fold_angle=40", "--json", "-o", dir / "modes"});
  REQUIRE(r.code == 0);
  const auto json = nlohmann::json::parse(r.out);
  CHECK(json["mechanism_motions"] == 1);
  CHECK(json["pose_t_s"] == 0.0);
  CHECK(json["frequencies_Hz"].size() == 23);
  for (const char* file : {"modes.csv", "mode_shapes.csv", "figures/modes.png"})
    CHECK(std::filesystem::exists(dir / "modes" + "/" + file));
  CHECK(json["one_sided"].empty());
  CHECK(contains(run_program({"modes", "pendulum"}).out, "rods are rigid"));
  // Its cable has its length at the start and bears nothing.
  CHECK(contains(run_program({"modes", "cable_ring"}).out, "which frequencies do not tell: cable)"));
  const ProgramResult never = run_program({"modes", "pendulum", "--at", "deployed"}),
                      soon = run_program({"modes", "pendulum", "--at", "soon"});
  CHECK(never.code == 2);
  CHECK(contains(never.err, "does not reach the deployed pose"));
  CHECK(soon.code == 2);
  CHECK(contains(soon.err, "--at takes start, end, deployed or a time from 0 to "));
  const auto check = nlohmann::json::parse(
      run_program({"check", "hoop6", "--json", "--set", "structure.youngs_modulus=7e10"}).out);
  CHECK(check["unique_rods"] == 30);
}

// With steps of 1 s the ladder's energy is off by far more than a tenth soon (docs/trust.md): what follows is
// no pose of its motion.
TEST_CASE("modes of a pose are judged as the run that leads to it") {
  const ScratchDirectory dir;
  const std::vector<std::string> coarse{"ladder", "--set", "solver.step=1"};
  const auto of = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), coarse.begin(), coarse.end());
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  REQUIRE(of({"run"}, {"-o", dir / "run"}).code == 4);
  const auto summary = nlohmann::json::parse(file_text(dir / "run/summary.json"));
  const double good = summary["final"]["t_s"];
  REQUIRE(good < 9);
  for (const char* at : {"9", "10"}) {
    const ProgramResult r = of({"modes"}, {"--at", at, "--json"});
    CHECK(r.code == 4);
    CHECK(r.out.empty());
    CHECK(contains(r.err, "unfurl: the solver failed: " + summary["message"].get<std::string>()));
    CHECK(contains(r.err, "the run is good up to "));
  }
  const ProgramResult end = of({"modes"}, {"--at", "end", "--json"});
  CHECK(end.code == 4);  // of the good part, and that it is not all is said
  CHECK(nlohmann::json::parse(end.out)["pose_t_s"] == good);
  CHECK(contains(end.err, "the solver failed"));
  CHECK(of({"render"}, {"--mode", "1", "--at", "9", "-o", dir / "film"}).code == 4);
}

// At 60 degrees the ring is driven to unfold: a stop there holds it, one behind it does not; friction that is
// larger than the drive sticks, less does not.
TEST_CASE("modes at the start: stops that hold and friction that sticks are locked") {
  const auto motions = [](const std::string& entry) {
    const ProgramResult r =
        run_program({"modes", "hoop6", "--set", "structure.fold_angle=60", "--set", entry, "--json"});
    REQUIRE(r.code == 0);
    return nlohmann::json::parse(r.out)["mechanism_motions"].get<int>();
  };
  const std::string stop = R"(constraints=[{kind="angle_stop",fold_angle=true,)";
  CHECK(motions(stop + "min=60}]") == 0);
  CHECK(motions(stop + "max=60}]") == 1);
  const std::string friction = R"(forces=[{kind="friction",fold_angle=true,kinetic=)";
  CHECK(motions(friction + "1e6}]") == 0);
  CHECK(motions(friction + "1}]") == 1);
}

TEST_CASE("check looks at distances of rods in what is good of the motion only") {
  const std::vector<std::string> long_steps = {"ladder", "--set", "solver.step=1", "--json", "--quiet"};
  const auto json_of = [&](const std::string& verb) {
    std::vector<std::string> words = long_steps;
    words.insert(words.begin(), verb);
    return nlohmann::json::parse(run_program(words).out);
  };
  const auto run = json_of("run"), clearance = json_of("check")["clearance"];
  REQUIRE(run["status"] == "failed");
  CHECK(clearance["until_s"] == run["final"]["t_s"]);
  CHECK(clearance["whole_motion"] == false);
}

TEST_CASE("options that would do nothing, or contradict each other, are refused") {
  const ScratchDirectory dir;
  const std::string png = dir / "p.png", record = dir / "r.jsonl";
  check_error(
      {"view", "hoop6", "--picture", png, "--record", record}, 2,
      "unfurl: --record beside --picture: there is no window whose session could be recorded; leave one of "
      "them out");
  CHECK(run_program({"view", "hoop6", "--bench", "--record", record}).code == 2);
  CHECK(run_program({"view", "--replay", record, "--record", record}).code == 2);
  CHECK(run_program({"view", "hoop6", "--bench", "--picture", png}).code == 2);
  CHECK(run_program({"view", "--replay", record, "--at", "1"}).code == 2);
  check_error({"view", "--replay", record, "--dark"}, 2,
              "unfurl: --dark beside --replay: a session looks as it was recorded; leave one of them out");
  CHECK(run_program({"view", "--replay", record, "--ui-scale", "2"}).code == 2);
  const ProgramResult no_png = run_program({"view", "--replay", record, "--picture", dir / "p.txt"});
  CHECK(no_png.code == 2);
  CHECK(contains(no_png.err, "a picture of the window is written as .png, not '.txt'"));
  const std::vector<std::string> sweep{"sweep",     "hoop6_sector", "--vary", "structure.fold_angle=40:80:3",
                                       "--measure", "deploy_time",  "-o",     dir / "out"};
  const auto with = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  check_error(with(sweep, {"--lease", "5"}), 2,
              "unfurl: --lease is for --join; add it, or leave --lease out");
  check_error({"render", "hoop6", "-o", dir / "out", "--lease", "5"}, 2,
              "unfurl: --lease is for --join; add it, or leave --lease out");
  check_error(with(sweep, {"--jobs", "3"}), 2, "unfurl: --jobs is for --script; add it, or leave --jobs out");
  check_error(with(sweep, {"--script", "slurm", "--merge", dir / "a"}), 2,
              "unfurl: --script prints a job that computes and then merges by itself; leave out --merge");
  CHECK(run_program({"run", "hoop6", "-o", dir / "out", "--plan", "--resume"}).code == 5);
  CHECK_FALSE(std::filesystem::exists(dir / "out"));
  check_error({"run", "hoop6", "-o", "a", "-o", "b"}, 2, "unfurl: -o is given more than once; give it once");
  check_error({"figure", "hoop6", "energy", "-o", "x.png", "--dpi", "90", "--dpi=91"}, 2,
              "unfurl: --dpi is given more than once; give it once");
  check_error({"render", "hoop6", "-o", "x", "--fps", "9", "--fps"}, 2,
              "unfurl: --fps needs a value behind it");
}

TEST_CASE("names in [render] are looked up before the work") {
  const ScratchDirectory dir;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", "hoop6"},
                                                {"render", "hoop6", "-o", dir / "out"},
                                                {"poster", "hoop6", "-o", dir / "p.png"}}) {
    std::vector<std::string> typed = words;
    typed.insert(typed.end(), {"--set", "render.trails=Tt0", "--set", "solver.step=1e-6"});
    const ProgramResult r = run_program(typed);
    CHECK(r.code == 3);
    CHECK(contains(r.err, "render.trails: no node matches 'Tt0'; did you mean"));
  }
}

TEST_CASE("lists") {
  CHECK(contains(run_program({"list", "structures"}).out, "fold_angle"));
  CHECK(contains(run_program({"list", "structures"}).out, "custom"));
  CHECK(contains(run_program({"list", "methods"}).out, "rk4"));
  CHECK(contains(run_program({"list", "constraints"}).out, "plane"));
  CHECK(contains(run_program({"list", "forces"}).out, "gravity"));
  CHECK(contains(run_program({"list", "scenes"}).out, "hoop6 "));
  const auto json = nlohmann::json::parse(run_program({"list", "structures", "--json"}).out);
  CHECK(json[0]["name"] == "hoop");
  CHECK(json[0]["parameters"][0]["name"] == "units");
}

TEST_CASE("scenes are looked for where UNFURL_ASSETS says") {
  const ScratchDirectory dir;
  dir.write("scenes/mine.toml", "title = 'Mine'\n[structure]\nkind = 'hoop'\n");
  const ProgramOptions here{.environment = {"UNFURL_ASSETS=" + (dir / "")}};
  CHECK(run_program({"list", "scenes"}, here).out == "mine  Mine\n");
  CHECK(run_program({"check", "mine"}, here).code == 0);
}

TEST_CASE("standard output that cannot be written is a file error") {
  const ProgramResult r = run_program({"check", "hoop6"}, {.out_file = "/dev/full"});
  CHECK(r.code == 5);
  CHECK(r.err == "unfurl: cannot write to standard output\n");
}

}  // namespace command_line_test
