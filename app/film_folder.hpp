// What DIR holds of a film: which one it is, and which of its frames are finished.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/scene/scene.hpp"

namespace unfurl {

// Changes with everything that changes a frame: the scene, the settings of its pictures, the program.
std::string film_fingerprint(const Scene& scene);

class FilmFolder {
 public:
  FilmFolder(std::filesystem::path directory, const Scene& scene);

  // Are there frames of another film, or of one that is not known? Then nothing may be added to them.
  bool holds_another() const;
  bool holds_this() const;  // this film was begun here
  bool fresh() const;       // no results of any kind
  // Say whose frames these will be. Throws FileError, as all that writes.
  void claim() const;

  std::filesystem::path frame(std::size_t index) const;  // frames/frame_00012.png
  bool finished(std::size_t index) const;                // a whole PNG file
  // Were the animations made with these settings, from the frames as they are? draw() forgets it.
  bool encoded() const;
  void set_encoded(bool encoded) const;

 private:
  std::filesystem::path directory_;
  std::string fingerprint_, encoding_;  // of the frames; of the films made of them
};

}  // namespace unfurl
