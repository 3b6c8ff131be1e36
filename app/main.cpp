// SPDX-License-Identifier: BSD-3-Clause
#include "app/cli.hpp"

int main(int argc, char** argv) {
  return unfurl::run_command_line({argv + (argc > 0 ? 1 : 0), argv + argc});
}
