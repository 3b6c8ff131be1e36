// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <ostream>

namespace unfurl {

// While it lives, what is written to the stream is printable_text (core/text/xml_text.hpp): titles, names
// and paths are anybody's, and a terminal obeys what it is sent. Text comes out at line breaks and flushes.
class PrintableOutput {
 public:
  explicit PrintableOutput(std::ostream& stream);
  ~PrintableOutput();
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;

 private:
  class Filter;
  void replace(std::streambuf* buffer);
  std::ostream& stream_;
  std::unique_ptr<Filter> filter_;
  std::streambuf* before_;
};

}  // namespace unfurl
