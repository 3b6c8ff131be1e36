// SPDX-License-Identifier: BSD-3-Clause
// What DIR holds of a film: which one it is, and which of its frames are finished.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include "app/output/written_files.hpp"
#include "core/scene/scene.hpp"

namespace unfurl {

// Changes with everything that changes a frame: the scene, the settings of its pictures, the program.
// `part`: what else it shows ("mode 3 at 0.5"); empty: the scene's motion.
std::string film_fingerprint(const Scene& scene, bool gpu = false, const std::string& part = {});

class FilmFolder {
 public:
  FilmFolder(std::filesystem::path directory, const Scene& scene, bool gpu = false,
             const std::string& part = {});

  // Are there frames of another film, or of one that is not known? Then nothing may be added to them.
  bool holds_another() const;
  bool holds_this() const;  // this film was begun here
  // Throws FileError where another one is, whose frames would go for a film of which nothing is drawn.
  void refuse_to_encode_another(bool encode_only) const;
  bool fresh() const;  // no results of any kind
  // Is a file of this name in DIR one of a film, its animations, figures and report, or its workers'?
  static bool is_of_film(const std::string& name);
  // Remove what a run or a film left; frames that unfurl did not draw, or that were changed since, are put
  // aside with their folder, so that no frame of another film stays among ours.
  static void clear(WrittenFiles& written);
  // Say whose frames these will be. Throws FileError, as all that writes.
  void claim() const;

  std::filesystem::path frame(std::size_t index) const;  // frames/frame_00012.png
  // Frames have the size of this one: a film of the motion's shape knows it when the motion is known.
  void fit(const Scene& shown);
  // Is it there, whole and of the film's size? What was once found so is not read again.
  bool finished(std::size_t index) const;
  // Is DIR/film ("animation.webp") there, as it was made with these settings from the frames as they are?
  bool encoded(const std::string& film) const;
  void set_encoded(const std::string& film) const;  // it was
  void forget_films() const;                        // frames change

 private:
  std::filesystem::path directory_;
  std::string fingerprint_, encoding_;  // of the frames; of the films made of them
  std::pair<int, int> size_;
  mutable std::set<std::size_t> whole_;
};

}  // namespace unfurl
