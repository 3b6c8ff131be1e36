// SPDX-License-Identifier: BSD-3-Clause
// A table of keys that are members of a struct: what is declared once is read, written and has its default.
#pragma once

#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "core/text/param_spec.hpp"

namespace unfurl {

// A key and where its value is kept in Options. The key's default is what Options{} has there.
template <class Options>
struct BoundParam {
  template <class T>
  using Of = T Options::*;
  using Range = std::array<double, 2>;
  using IntPair = std::pair<Of<int>, Of<int>>;  // of a key of two whole numbers

  ParamSpec spec;
  std::variant<Of<bool>, Of<int>, Of<double>, Of<std::string>, Of<Range>, IntPair> member;

  ParamValue value(const Options& o) const {
    if (const auto* m = std::get_if<Of<bool>>(&member)) return o.*(*m);
    if (const auto* m = std::get_if<Of<int>>(&member)) return static_cast<long>(o.*(*m));
    if (const auto* m = std::get_if<Of<double>>(&member)) return o.*(*m);
    if (const auto* m = std::get_if<Of<std::string>>(&member)) return o.*(*m);
    if (const auto* m = std::get_if<Of<Range>>(&member))
      return std::vector((o.*(*m)).begin(), (o.*(*m)).end());
    const IntPair pair = std::get<IntPair>(member);
    return std::vector{static_cast<double>(o.*pair.first), static_cast<double>(o.*pair.second)};
  }

  // values: checked against the spec.
  void assign(Options& o, const ParamSet& values) const {
    const std::string_view name = spec.name;
    if (const auto* m = std::get_if<Of<bool>>(&member)) {
      o.*(*m) = values.boolean(name);
    } else if (const auto* n = std::get_if<Of<int>>(&member)) {
      o.*(*n) = static_cast<int>(values.integer(name));
    } else if (const auto* x = std::get_if<Of<double>>(&member)) {
      o.*(*x) = values.real(name);
    } else if (const auto* text = std::get_if<Of<std::string>>(&member)) {
      o.*(*text) = values.text(name);
    } else if (const auto* range = std::get_if<Of<Range>>(&member)) {
      o.*(*range) = {values.vector(name)[0], values.vector(name)[1]};
    } else {
      const IntPair pair = std::get<IntPair>(member);
      o.*pair.first = static_cast<int>(values.vector(name)[0]);
      o.*pair.second = static_cast<int>(values.vector(name)[1]);
    }
  }
};

template <class Options>
class ParamBinding {
 public:
  explicit ParamBinding(std::vector<BoundParam<Options>> rows) : rows_(std::move(rows)) {
    static const Options defaults;
    for (BoundParam<Options>& row : rows_) {
      if (!row.spec.required) row.spec.fallback = row.value(defaults);
      specs_.push_back(row.spec);
    }
  }

  const std::vector<ParamSpec>& specs() const { return specs_; }

  Options read(const ParamSet& values) const {
    Options options;
    for (const auto& row : rows_) row.assign(options, values);
    return options;
  }

  ParamSet values(const Options& options) const {
    ParamSet out;
    for (const auto& row : rows_) out.set(row.spec.name, row.value(options));
    return out;
  }

 private:
  std::vector<BoundParam<Options>> rows_;
  std::vector<ParamSpec> specs_;
};

}  // namespace unfurl
