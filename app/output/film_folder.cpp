// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/film_folder.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/output/json_text.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/checksum.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/text/version.hpp"
#include "render/image/png.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  return read_text_file(path.string()).text;
}

bool holds_frames(const fs::path& directory) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory / "frames", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && name.ends_with(".png")) return true;
  }
  return false;
}

nlohmann::json record_of(const fs::path& directory) {
  auto json = nlohmann::json::parse(text_of(directory / "film.json"), nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

}  // namespace

std::string film_fingerprint(const Scene& scene, bool gpu, const std::string& part) {
  Scene bare = scene;
  bare.render = without_encoding(scene.render);
  bare.locations.erase("render.mp4");  // asked for or not
  Checksum hash;
  hash.add(scene_text(bare));
  hash.add(text_of("/proc/self/exe"));  // another build may draw otherwise
  hash.add(version());
  if (gpu) hash.add("drawn on the graphics processor");
  hash.add(part);
  return hash.text();
}

FilmFolder::FilmFolder(fs::path directory, const Scene& scene, bool gpu, const std::string& part)
    : directory_(std::move(directory)),
      fingerprint_(film_fingerprint(scene, gpu, part)),
      size_(scene.render.width, scene.render.height) {
  Checksum hash;
  hash.add(fingerprint_);
  Scene wanted = scene;
  wanted.locations.erase("render.mp4");
  hash.add(scene_text(wanted));
  encoding_ = hash.text();
}

bool FilmFolder::holds_this() const {
  return text_in(record_of(directory_), "fingerprint") == fingerprint_;
}

bool FilmFolder::holds_another() const {
  return !holds_this() && holds_frames(directory_);
}

void FilmFolder::refuse_to_encode_another(bool encode_only) const {
  if (encode_only && holds_another())
    throw FileError(
        directory_,
        "holds frames of another film, and --encode-only draws none; leave that out, or use another -o");
}

void FilmFolder::clear(WrittenFiles& written) {
  written.remove_all();
  if (holds_frames(written.directory())) written.keep_aside("frames");
}

bool FilmFolder::is_of_film(const std::string& name) {
  const bool animation = name.starts_with("animation.") && !name.ends_with(".glb");  // which is an export
  return animation || name.starts_with("frames/") || name.starts_with("figures/") || name == "film.json" ||
         name == "report.html" || name.starts_with("join/");  // of those who draw it together
}

bool FilmFolder::fresh() const {
  std::error_code error;
  return !holds_another() && !fs::exists(directory_ / "summary.json", error);
}

void FilmFolder::claim() const {
  const fs::path frames = directory_ / "frames";
  std::error_code error;
  fs::create_directories(frames, error);
  if (error) throw FileError(frames, error.value());
  if (!holds_this()) forget_films();
}

void FilmFolder::fit(const Scene& shown) {
  size_ = {shown.render.width, shown.render.height};
}

fs::path FilmFolder::frame(std::size_t index) const {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame_%05zu.png", index);
  return directory_ / "frames" / name.data();
}

// Our frames appear whole or not at all, but a copy between machines may have been cut short, and disks fail.
bool FilmFolder::finished(std::size_t index) const {
  if (whole_.contains(index)) return true;
  if (whole_png(frame(index)) != size_) return false;
  whole_.insert(index);
  return true;
}

bool FilmFolder::encoded(const std::string& film) const {
  const nlohmann::json record = record_of(directory_);
  const auto films = record.find("films");
  if (films == record.end() || !films->is_object() || !films->contains(film)) return false;
  const std::string sum = text_in((*films)[film], "checksum");
  return !sum.empty() && text_in((*films)[film], "settings") == encoding_ &&
         sum == checksum_of_file(directory_ / film);
}

void FilmFolder::set_encoded(const std::string& film) const {
  nlohmann::json record = record_of(directory_);
  record["films"][film] = {{"settings", encoding_}, {"checksum", checksum_of_file(directory_ / film)}};
  write_file_atomically(directory_ / "film.json", record.dump(2) + "\n");
}

void FilmFolder::forget_films() const {
  const nlohmann::ordered_json record = {
      {"unfurl", version()}, {"fingerprint", fingerprint_}, {"films", nlohmann::json::object()}};
  write_file_atomically(directory_ / "film.json", record.dump(2) + "\n");
}

}  // namespace unfurl
