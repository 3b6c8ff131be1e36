// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace unfurl {

// Empty where there is no such text: the file may be anybody's.
inline std::string text_in(const nlohmann::json& record, const char* key) {
  const auto found = record.is_object() ? record.find(key) : record.end();
  return found != record.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace unfurl
