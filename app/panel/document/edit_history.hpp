// SPDX-License-Identifier: BSD-3-Clause
// Undo and redo of everything that was changed in a scene.
#pragma once

#include <string>
#include <vector>

#include "app/panel/document/scene_document.hpp"

namespace unfurl {

class EditHistory {
 public:
  explicit EditHistory(SceneDocument document) : now_(std::move(document)) {}

  const SceneDocument& now() const { return now_; }
  // A change of one key; changes of the same key join into one step until end_gesture, so that a slider's way
  // from press to release is undone at once. Equal values are no change.
  void edit(const std::string& key, ParamValue value);
  // Many keys at once; changes of one gesture join.
  void change(const std::string& gesture, SceneDocument document);
  void take_back(const std::string& key);  // what the present gesture has made of it, as if it had not been
  void forget(const std::string& key);     // back to the file's value
  void replace(SceneDocument document);    // another form of the scene, or none of the edits
  void open(SceneDocument document);       // another scene: the present one is left
  // The same scene, now in a file: no step. With a new name what undo and redo lead to has that name, too.
  void saved(SceneDocument document);
  void end_gesture() { gesture_.clear(); }

  // How many steps back there is another scene that was left with changes which are in no file; 0: nowhere.
  int steps_to_left() const;

  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  bool undo() { return step(past_, future_); }  // false: there was nothing to undo
  bool redo() { return step(future_, past_); }

 private:
  struct Step {
    SceneDocument document;
    bool opens = false;  // between it and the one next to it towards the present another scene was opened
  };
  void remember();
  void begin(const std::string& gesture);
  bool step(std::vector<Step>& from, std::vector<Step>& to);
  static constexpr std::size_t deepest = 10000;

  SceneDocument now_;
  std::vector<Step> past_, future_;
  std::vector<Step> undone_;  // before the present gesture
  std::string gesture_;       // the key that is being changed
};

}  // namespace unfurl
