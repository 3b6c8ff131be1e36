#include "app/film_folder.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

// FNV-1a with 64 bits: tells films apart, does not protect from malice.
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  std::string text() const {
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(value_));
    return digits.data();
  }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

std::string text_of(const fs::path& path) {
  return read_text_file(path.string()).text;
}

nlohmann::json record_of(const fs::path& directory) {
  auto json = nlohmann::json::parse(text_of(directory / "film.json"), nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

}  // namespace

std::string film_fingerprint(const Scene& scene) {
  Scene bare = scene;
  bare.render = without_encoding(scene.render);
  Hash hash;
  hash.add(scene_text(bare));
  hash.add(text_of("/proc/self/exe"));  // another build may draw otherwise
  hash.add(UNFURL_VERSION);
  return hash.text();
}

FilmFolder::FilmFolder(fs::path directory, const Scene& scene)
    : directory_(std::move(directory)), fingerprint_(film_fingerprint(scene)) {
  Hash hash;
  hash.add(fingerprint_);
  hash.add(scene_text(scene));
  encoding_ = hash.text();
}

bool FilmFolder::holds_this() const {
  return record_of(directory_).value("fingerprint", "") == fingerprint_;
}

bool FilmFolder::holds_another() const {
  if (holds_this()) return false;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory_ / "frames", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && name.ends_with(".png")) return true;
  }
  return false;
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
  if (!holds_this()) set_encoded(false);
}

fs::path FilmFolder::frame(std::size_t index) const {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame_%05zu.png", index);
  return directory_ / "frames" / name.data();
}

// Our frames appear whole or not at all, but a copy between machines may have been cut short.
bool FilmFolder::finished(std::size_t index) const {
  std::ifstream in(frame(index), std::ios::binary | std::ios::ate);
  constexpr std::string_view end("IEND\xae\x42\x60\x82", 8);
  if (!in || in.tellg() < static_cast<std::streamoff>(end.size())) return false;
  std::string tail(end.size(), '\0');
  in.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return tail == end;
}

bool FilmFolder::encoded() const {
  return record_of(directory_).value("encoded", "") == encoding_;
}

void FilmFolder::set_encoded(bool encoded) const {
  const nlohmann::ordered_json record = {
      {"unfurl", UNFURL_VERSION}, {"fingerprint", fingerprint_}, {"encoded", encoded ? encoding_ : ""}};
  write_file_atomically(directory_ / "film.json", record.dump(2) + "\n");
}

}  // namespace unfurl
