// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/pdf_document.hpp"

#include <zlib.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <new>

#include "core/text/utf8.hpp"

namespace unfurl::plot {
namespace {

std::string compressed(std::string_view data) {
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  std::string out(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                             reinterpret_cast<const Bytef*>(data.data()), static_cast<uLong>(data.size()), 9);
  if (code != Z_OK) throw std::bad_alloc();
  out.resize(size);
  return out;
}

}  // namespace

int PdfDocument::reserve() {
  objects_.emplace_back();
  return static_cast<int>(objects_.size());
}

void PdfDocument::put(int object, std::string_view body) {
  objects_[static_cast<std::size_t>(object - 1)] = body;
}

int PdfDocument::add(std::string_view body) {
  const int object = reserve();
  put(object, body);
  return object;
}

int PdfDocument::add_stream(std::string_view data, std::string_view entries) {
  const std::string packed = compressed(data);
  return add("<< /Length " + std::to_string(packed.size()) + " /Filter /FlateDecode " + std::string(entries) +
             " >>\nstream\n" + packed + "\nendstream");
}

std::string PdfDocument::finish(int catalog, int info) const {
  std::string out = "%PDF-1.5\n%\xE2\xE3\xCF\xD3\n";  // bytes above 127: a binary file
  std::string places = "0000000000 65535 f \n";
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    char place[32];
    std::snprintf(place, sizeof place, "%010zu 00000 n \n", out.size());
    places += place;
    out += std::to_string(i + 1) + " 0 obj\n" + objects_[i] + "\nendobj\n";
  }
  const std::string count = std::to_string(objects_.size() + 1), start = std::to_string(out.size());
  out += "xref\n0 " + count + "\n" + places;
  out += "trailer\n<< /Size " + count + " /Root " + std::to_string(catalog) + " 0 R /Info " +
         std::to_string(info) + " 0 R >>\nstartxref\n" + start + "\n%%EOF\n";
  return out;
}

std::string pdf_number(double value) {
  char text[64];
  const double rounded = std::round(value * 1000) / 1000 + 0.0;  // no "-0"
  return {text, std::to_chars(text, text + sizeof text, rounded, std::chars_format::fixed).ptr};
}

std::string hex4(unsigned v) {
  char text[8];
  std::snprintf(text, sizeof text, "%04X", v & 0xFFFF);
  return text;
}

std::string pdf_string(std::string_view utf8) {
  std::string out = "<FEFF";
  for (const char16_t unit : utf16(utf8)) out += hex4(unit);
  return out + ">";
}

}  // namespace unfurl::plot
