// SPDX-License-Identifier: BSD-3-Clause
// ./dev bench: frames a second, split into simulate, build, draw, read back and encode; then all of it with
// files on disk. Printed and written as CSV (first argument, else bench_frames.csv).
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <thread>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "render/gl/functions.hpp"
#include "render/image/png.hpp"
#include "render/image/task_queue.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"

using namespace unfurl;

namespace {

constexpr int frames = 120;  // spread over the run

// CPU time of all threads: the machine may have other work to do, which wall time would count.
double cpu_seconds(const std::function<void()>& work) {
  const std::clock_t before = std::clock();
  work();
  return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void bench(std::FILE* csv, const char* name, const std::vector<std::string>& overrides) {
  const Scene scene = read_scene_file(find_scene("hoop6"), overrides);
  auto model = build_model(scene);
  std::unique_ptr<Simulation> run;
  const double simulating =
      cpu_seconds([&] { run = std::make_unique<Simulation>(simulate(model, scene.solver)); });
  FrameStyle style;
  style.title = scene.title;
  const auto context = make_offscreen_context();
  std::unique_ptr<FrameBuilder> builder;
  const double preparing =
      cpu_seconds([&] { builder = std::make_unique<FrameBuilder>(run->trajectory, style); });
  Renderer renderer(*context, style.width, style.height);
  const auto time = [&](int k) { return run->trajectory.end_time() * k / (frames - 1); };
  renderer.draw(builder->build(0));  // compiles the shaders
  double building = 0, drawing = 0, reading = 0, encoding = 0;
  for (int k = 0; k < frames; ++k) {
    DrawList list;
    Image image;
    building += cpu_seconds([&] { list = builder->build(time(k)); });
    drawing += cpu_seconds([&] { renderer.paint(list), gl::Finish(); });
    reading += cpu_seconds([&] { image = renderer.read(); });
    encoding += cpu_seconds([&] { encode_png(image); });
  }
  const auto folder = std::filesystem::temp_directory_path() / "unfurl_frames_bench";
  std::filesystem::create_directories(folder);
  double whole = 0;
  const double cpu = cpu_seconds([&] {
    whole = seconds([&] {
      TaskQueue writers(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
      for (int k = 0; k < frames; ++k) {
        auto image = std::make_shared<const Image>(renderer.draw(builder->build(time(k))));
        writers.add([image, path = folder / (std::to_string(k) + ".png")] { write_png(path, *image); });
      }
      writers.finish();
    });
  });
  std::filesystem::remove_all(folder);
  const double ms = 1000.0 / frames;
  // On two cores the CPU time of a frame bounds the rate: 133 ms are 15 frames a second.
  std::printf("%-10s %9.3f %9.3f %7.2f %7.2f %9.2f %7.2f %9.1f %9.1f\n", name, simulating, preparing,
              ms * building, ms * drawing, ms * reading, ms * encoding, frames / whole, ms * cpu);
  std::fflush(stdout);
  std::fprintf(csv, "%s,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", name, simulating, preparing,
               ms * building, ms * drawing, ms * reading, ms * encoding, frames / whole, ms * cpu);
}

}  // namespace

int main(int count, char** words) {
  const char* path = count > 1 ? words[1] : "bench_frames.csv";
  std::FILE* csv = std::fopen(path, "w");
  if (!csv) {
    std::fprintf(stderr, "cannot write %s\n", path);
    return 5;
  }
  std::fprintf(csv,
               "units,simulate_s,prepare_s,build_ms,draw_ms,read_back_ms,encode_ms,all_fps,all_cpu_ms\n");
  std::printf(
      "1280 x 720, 4 samples a pixel, shadows; CPU time of all threads\n%-10s %9s %9s %7s %7s %9s %7s %9s "
      "%9s\n",
      "", "simulate", "prepare", "build", "draw", "read back", "encode", "all, with", "all, CPU");
  std::printf("%-10s %9s %9s %7s %7s %9s %7s %9s %9s\n", "units", "(s)", "(s)", "(ms)", "(ms)", "(ms)",
              "(ms)", "files (fps)", "(ms)");
  bench(csv, "6", {});
  bench(csv, "24", {"structure.units=24", "structure.fold_angle=85"});
  bench(csv, "100",
        {"structure.units=100", "structure.fold_angle=85", "structure.model=sector", "solver.end_time=40"});
  if (std::fclose(csv) != 0) return 5;
  std::printf("\n%s\n", path);
}
