#include "app/own_options.hpp"

namespace unfurl {

namespace {

constexpr OwnOption rows[] = {
    {"--steps", "LARGEST:SMALLEST", "the ladder of steps [s], each half the one before"},
    {"--repeats", "N", "timed runs per point, at most (5)"},
    {"--models", "", "compare models of the scene instead of methods"},
};

}  // namespace

std::span<const OwnOption> own_options() {
  return rows;
}

bool takes(const Command& command, std::string_view option) {
  std::string_view rest = command.options;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == option) return true;
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  }
  return false;
}

}  // namespace unfurl
