// SPDX-License-Identifier: BSD-3-Clause
// A binary glTF 2.0 file as it is put together.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/text/version.hpp"

namespace unfurl {

// The document and its one buffer.
class GlbFile {
 public:
  nlohmann::ordered_json json;

  GlbFile() {
    json["asset"] = {{"version", "2.0"}, {"generator", "Unfurl " + version()}};
    json["scene"] = 0;
    for (const char* key : {"scenes", "nodes", "materials", "meshes"})
      json[key] = nlohmann::ordered_json::array();
    for (const char* key : {"accessors", "bufferViews"}) json[key] = nlohmann::ordered_json::array();
  }

  // An accessor of `width` numbers an element; bounds where glTF wants them. Returns its index.
  template <class T>
  std::size_t add(const std::vector<T>& values, std::size_t width, int component, int target, bool bounds) {
    static constexpr const char* types[] = {"", "SCALAR", "", "VEC3", "VEC4"};
    buffer_.resize((buffer_.size() + 3) / 4 * 4, 0);
    nlohmann::ordered_json view = {
        {"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (target) view["target"] = target;
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    buffer_.append(bytes, values.size() * sizeof(T));
    nlohmann::ordered_json accessor = {{"bufferView", json["bufferViews"].size()},
                                       {"componentType", component},
                                       {"count", values.size() / width},
                                       {"type", types[width]}};
    for (std::size_t k = 0; bounds && k < width; ++k) {
      T low = values[k], high = values[k];
      for (std::size_t i = k; i < values.size(); i += width) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      accessor["min"].push_back(low);
      accessor["max"].push_back(high);
    }
    json["bufferViews"].push_back(std::move(view));
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }

  std::string file() {
    buffer_.resize((buffer_.size() + 3) / 4 * 4, 0);
    json["buffers"] = {{{"byteLength", buffer_.size()}}};
    std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF" + word(2) + word(12 + 8 + text.size() + 8 + buffer_.size());
    out += word(text.size()) + "JSON" + text;
    return out + word(buffer_.size()) + std::string("BIN\0", 4) + buffer_;
  }

 private:
  static std::string word(std::size_t value) {
    static_assert(std::endian::native == std::endian::little);
    const auto x = static_cast<std::uint32_t>(value);
    return {reinterpret_cast<const char*>(&x), sizeof x};
  }
  std::string buffer_;
};

}  // namespace unfurl
