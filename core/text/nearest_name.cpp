// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/nearest_name.hpp"

#include <algorithm>
#include <cctype>

#include "core/text/utf8.hpp"

namespace unfurl {

namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

// Behind a name: in brackets, or a word that begins with a unit, as in "_mm", " kg", "_deg_per_s".
bool is_unit(std::string_view text) {
  constexpr std::string_view units =
      " m mm cm dm km um nm in inch inches ft feet mil deg degrees rad grad turns rev kg g mg t lb lbs oz "
      "n kn mn nm kgf lbf pa kpa mpa gpa psi bar s ms us ns sec min h hz khz rpm rps k c w kw j kj percent "
      "metre metres meter meters millimetres millimeters gram grams kilograms tons tonnes radians newton "
      "newtons "
      "ns nms nsm kgm gcm \u00B5m \u00B0c "
      "pascal second seconds minutes hours kelvin watts ";
  if (text.front() == '(' || text.front() == '[') return true;
  if (text.front() != '_' && text.front() != ' ') return false;
  text.remove_prefix(1);
  if (text.starts_with('(') || text.starts_with('[')) return true;
  if (text == "A" || text == "V") return true;  // small, they are names
  std::string word = " ";
  for (const char c : text.substr(0, text.find_first_of("_/^*0123456789 ."))) word += lower(c);
  return word.size() > 1 && units.find(word + " ") != std::string_view::npos;
}

// Optimal string alignment distance; anything above `limit` may be returned as limit + 1.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  const std::size_t gap = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  if (gap > limit) return limit + 1;
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(previous);
    previous.swap(row);
  }
  return previous[b.size()];
}

}  // namespace

std::string_view nearest_name(std::string_view given, const std::vector<std::string_view>& known) {
  if (given.empty() || given.size() > 80) return "";
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(1, given.size() / 3) + 1;
  for (const auto name : known) {
    const std::size_t distance = edit_distance(given, name, best_distance - 1);
    if (distance < best_distance && distance < std::max(given.size(), name.size())) {
      best = name;
      best_distance = distance;
    }
  }
  if (!best.empty() || given.size() < 3) return best;
  for (const auto name : known)
    if (name.starts_with(given)) return name;
  return "";
}

std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& known,
                         std::string_view all) {
  if (const auto near = nearest_name(given, known); !near.empty())
    return "; did you mean " + in_quotes(near) + "?";
  if (known.empty()) return "";
  std::string text = "; known: ";
  constexpr std::size_t most = 12;
  for (std::size_t i = 0; i < std::min(most, known.size()); ++i) text.append(i ? ", " : "").append(known[i]);
  if (known.size() <= most) return text;
  return text + ", ..." + (all.empty() ? "" : "; " + std::string(all) + " tells all");
}

std::string_view name_before_unit(std::string_view given, const std::vector<std::string_view>& known) {
  std::string_view stem;
  for (const auto name : known)
    if (name.size() > stem.size() && name.size() < given.size() && given.starts_with(name) &&
        is_unit(given.substr(name.size())))
      stem = name;
  const std::string_view near = nearest_name(given, known);
  return near.empty() || near == stem || stem.starts_with(near) ? stem : "";
}

std::string in_quotes(std::string_view name) {
  constexpr std::size_t most = 60;
  constexpr std::string_view hex = "0123456789abcdef";
  std::string text = "'";
  for (std::size_t i = 0; i < utf8_cut(name, most); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    if (byte < 0x20 || byte == 0x7f)
      text.append("\\x").append(1, hex[byte >> 4]).append(1, hex[byte & 15]);
    else
      text += name[i];
  }
  return text + (name.size() > most ? "...'" : "'");
}

}  // namespace unfurl
