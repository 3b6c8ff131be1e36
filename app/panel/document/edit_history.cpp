// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/edit_history.hpp"

namespace unfurl {

void EditHistory::remember() {
  past_.push_back({now_, false});
  if (past_.size() > deepest) past_.erase(past_.begin());
  future_.clear();
}

void EditHistory::begin(const std::string& gesture) {
  if (gesture_ == gesture) return;
  undone_ = std::move(future_);
  remember();
  gesture_ = gesture;
}

void EditHistory::edit(const std::string& key, ParamValue value) {
  const auto it = now_.edits.find(key);
  if (it != now_.edits.end() && it->second == value) return;
  begin(key);
  now_.edits[key] = std::move(value);
}

void EditHistory::change(const std::string& gesture, SceneDocument document) {
  if (document == now_) return;
  begin(gesture);
  now_ = std::move(document);
}

void EditHistory::take_back(const std::string& key) {
  if (gesture_ != key || past_.empty()) return;
  now_ = std::move(past_.back().document);
  past_.pop_back();
  future_ = std::move(undone_);
  end_gesture();
}

void EditHistory::forget(const std::string& key) {
  end_gesture();
  if (!now_.edits.contains(key)) return;
  remember();
  now_.edits.erase(key);
}

void EditHistory::replace(SceneDocument document) {
  end_gesture();
  if (document == now_) return;
  remember();
  now_ = std::move(document);
}

void EditHistory::open(SceneDocument document) {
  end_gesture();
  if (document == now_) return;
  remember();
  past_.back().opens = true;
  now_ = std::move(document);
}

void EditHistory::saved(SceneDocument document) {
  end_gesture();
  if (now_.path != document.path)
    for (std::vector<Step>* steps : {&past_, &future_})
      for (auto step = steps->rbegin(); step != steps->rend() && !step->opens; ++step) {
        step->document.path = document.path;
        step->document.name = document.name;
        step->document.folder = document.folder;
      }
  now_ = std::move(document);
}

int EditHistory::steps_to_left() const {
  int steps = 0;
  for (auto past = past_.rbegin(); past != past_.rend(); ++past) {
    ++steps;
    if (past->opens && is_edited(past->document)) return steps;
  }
  return 0;
}

bool EditHistory::step(std::vector<Step>& from, std::vector<Step>& to) {
  end_gesture();
  if (from.empty()) return false;
  to.push_back({std::move(now_), from.back().opens});
  now_ = std::move(from.back().document);
  from.pop_back();
  return true;
}

}  // namespace unfurl
