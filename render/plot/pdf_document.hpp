// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl::plot {

// The objects of a PDF file (ISO 32000-1) and the table that says where each is. The same bytes every time.
class PdfDocument {
 public:
  int reserve();  // the number of an object that comes later
  void put(int object, std::string_view body);
  int add(std::string_view body);
  // A compressed stream; `entries` of its dictionary beside its lengths.
  int add_stream(std::string_view data, std::string_view entries = {});
  // The whole file.
  std::string finish(int catalog, int info) const;

 private:
  std::vector<std::string> objects_;
};

std::string hex4(unsigned v);          // four hexadecimal digits
std::string pdf_number(double value);  // three decimals at most, as few digits as can be
// As a string of any language: UTF-16 in hexadecimal.
std::string pdf_string(std::string_view utf8);

}  // namespace unfurl::plot
