// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/study/reproduce.hpp"

namespace unfurl {

// Where the pictures of the report are, relative to it.
struct ReproductionPictures {
  std::string poses, constraint_error, trajectory_error;
};

// The reproduction for a reader who knows neither the paper nor the program.
Report reproduction_report(const Reproduction& r, const ReproductionPictures& pictures);

}  // namespace unfurl
