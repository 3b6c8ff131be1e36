// SPDX-License-Identifier: BSD-3-Clause
// The JSON that unfurl leaves for itself: film.json beside frames, window.json of the panel.
#include "tests/fuzz/fuzz.hpp"

#include "app/output/film_folder.hpp"
#include "app/panel/settings.hpp"

using namespace unfurl;

void unfurl::fuzz::try_text(std::string_view text) {
  if (text.size() > 8000) return;
  const ScratchFile file("film.json", text);
  static const Scene scene;
  static const FilmFolder film(file.path().parent_path(), scene);  // hashes this program
  require(!(film.holds_this() && film.holds_another()), "a film is this or another");
  film.encoded("animation.gif");
  const PanelSettings settings = load_settings(file.path());
  require(settings.width > 0 && settings.height > 0 && settings.left_width > 0, "settings are within reason");
}
