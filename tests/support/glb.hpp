// SPDX-License-Identifier: BSD-3-Clause
// A binary glTF file, taken apart by nothing but its specification.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace unfurl::testing {

template <class T>
std::vector<T> values_of(std::string_view bytes) {
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

struct Glb {
  nlohmann::json json;
  std::string data;  // of the one buffer

  explicit Glb(const std::string& file) {
    const std::size_t length = values_of<std::uint32_t>(std::string_view(file).substr(12, 4)).at(0);
    json = nlohmann::json::parse(file.substr(20, length));
    data = file.substr(28 + length);
  }

  std::vector<float> floats(std::size_t accessor) const {
    const auto& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()];
    return values_of<float>(std::string_view(data).substr(view.value("byteOffset", 0U), view["byteLength"]));
  }

  // Keys of a node's "translation", "rotation" or "scale", and their times; none: it does not change.
  std::vector<float> keys(std::size_t node, const std::string& path) const {
    return sampled(node, path, "output");
  }
  std::vector<float> times(std::size_t node, const std::string& path) const {
    return sampled(node, path, "input");
  }

 private:
  std::vector<float> sampled(std::size_t node, const std::string& path, const char* what) const {
    const auto& animation = json["animations"][0];
    for (const auto& channel : animation["channels"])
      if (channel["target"]["node"] == node && channel["target"]["path"] == path)
        return floats(animation["samplers"][channel["sampler"].get<std::size_t>()][what]);
    return {};
  }
};

}  // namespace unfurl::testing
