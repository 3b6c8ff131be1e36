// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/receipt_formats.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

#include "core/export/checksum.hpp"

namespace unfurl {

namespace {

std::string big_endian(std::uint32_t x) {
  return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
          static_cast<char>(x)};
}
std::string little_endian(std::uint32_t x) {
  std::string bytes = big_endian(x);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}
std::uint32_t number_at(std::string_view file, std::size_t at, bool little) {
  std::uint32_t x = 0;
  for (std::size_t i = 0; i < 4; ++i)
    x = x << 8 | static_cast<unsigned char>(file[at + (little ? 3 - i : i)]);
  return x;
}
std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

// PNG specification 5.3, 11.3.4.3: a chunk tEXt is keyword, NUL, text; the file ends with the 12 bytes of
// IEND.
std::string png_with(std::string file, std::string_view note) {
  if (file.size() < 12) return file;
  const std::string body = "tEXtUnfurl" + std::string(1, '\0') + std::string(note);
  const std::string chunk =
      big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(crc_of(body));
  return file.insert(file.size() - 12, chunk);
}
// The chunk's own checksum, once its text has changed.
void renew_png_chunk(std::string& file, std::size_t note) {
  constexpr std::size_t keyword = 7;
  const std::size_t type = note - keyword - 4;
  const std::size_t length = number_at(file, type - 4, false);
  if (file.compare(type, 4, "tEXt") != 0 || type + 4 + length + 4 > file.size()) return;
  file.replace(type + 4 + length, 4, big_endian(crc_of(std::string_view(file).substr(type, length + 4))));
}

std::string svg_with(std::string file, std::string_view note) {
  const std::size_t svg = file.find("<svg"), end = file.find('>', svg);
  if (svg == std::string::npos || end == std::string::npos) return file;
  return file.insert(end + 1, "\n<metadata>" + std::string(note) + "</metadata>");
}

std::string html_with(std::string file, std::string_view note) {
  const std::size_t end = file.rfind("</body>");
  return file.insert(
      end == std::string::npos ? file.size() : end,
      "<script type=\"application/json\" id=\"unfurl-receipt\">" + std::string(note) + "</script>\n");
}

// The text between two marks behind `from`.
std::string between(std::string_view file, std::string_view begin, std::string_view end, std::size_t from) {
  const std::size_t a = file.find(begin, from);
  if (a == std::string_view::npos) return "";
  const std::size_t first = a + begin.size(), b = file.find(end, first);
  return std::string(b == std::string_view::npos ? "" : file.substr(first, b - first));
}

// An incremental update (PDF 1.7, 7.5.6) with the document information (14.3.3) anew, one entry more.
std::string pdf_with(std::string file, std::string_view note) {
  const std::size_t trailer = file.rfind("trailer\n");
  if (trailer == std::string::npos) return file;
  const std::string size = between(file, "/Size ", " ", trailer),
                    root = between(file, "/Root ", " ", trailer),
                    info = between(file, "/Info ", " ", trailer),
                    start = between(file, "startxref\n", "\n", trailer),
                    old = between(file, "\n" + info + " 0 obj\n<<", ">>\nendobj", 0);
  if (size.empty() || root.empty() || info.empty() || start.empty() || old.empty()) return file;
  std::string text;
  for (const char c : note) text += (c == '(' || c == ')' || c == '\\' ? "\\" : "") + std::string(1, c);
  const std::size_t object = file.size();
  file += info + " 0 obj\n<<" + old + "/Unfurl (" + text + ") >>\nendobj\n";
  const std::size_t table = file.size();
  std::array<char, 24> place{};
  std::snprintf(place.data(), place.size(), "%010zu 00000 n \n", object);
  return file + "xref\n" + info + " 1\n" + place.data() + "trailer\n<< /Size " + size + " /Root " + root +
         " 0 R /Info " + info + " 0 R /Prev " + start + " >>\nstartxref\n" + std::to_string(table) +
         "\n%%EOF\n";
}
std::string from_pdf(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i)
    plain += text[i] == '\\' && i + 1 < text.size() ? text[++i] : text[i];
  return plain;
}

// glTF 2.0, binary: a header of 12 bytes, then the JSON chunk, padded with spaces to a multiple of four.
std::string glb_with(std::string file, std::string_view note) {
  constexpr std::size_t header = 12, chunk_header = 8;
  constexpr std::string_view asset = "\"asset\":{";
  if (file.size() < header + chunk_header) return file;
  const std::size_t length = number_at(file, header, true);
  if (file.size() < header + chunk_header + length) return file;
  std::string json = file.substr(header + chunk_header, length);
  const std::size_t at = json.find(asset);
  if (at == std::string::npos) return file;
  json.insert(at + asset.size(), "\"extras\":{\"unfurl\":" + std::string(note) + "},");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out = file.substr(0, 8) + "size" + little_endian(static_cast<std::uint32_t>(json.size())) +
                    "JSON" + json + file.substr(header + chunk_header + length);
  return out.replace(8, 4, little_endian(static_cast<std::uint32_t>(out.size())));
}

// WebP container: RIFF chunks of even size; the header VP8X says by a bit that metadata in XMP follow.
std::string webp_with(std::string file, std::string_view note) {
  if (file.size() < 30 || file.compare(12, 4, "VP8X") != 0) return file;
  constexpr char xmp_bit = 4;
  std::string packet =
      "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
      "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description rdf:about=\"\" "
      "xmlns:dc=\"http://purl.org/dc/elements/1.1/\"><dc:source>" +
      std::string(note) + "</dc:source></rdf:Description></rdf:RDF></x:xmpmeta>";
  if (packet.size() % 2 == 1) packet += ' ';
  file[20] = static_cast<char>(file[20] | xmp_bit);
  file += "XMP " + little_endian(static_cast<std::uint32_t>(packet.size())) + packet;
  return file.replace(4, 4, little_endian(static_cast<std::uint32_t>(file.size() - 8)));
}

// GIF89a 24: a comment is blocks of up to 255 bytes, each behind its size; the file ends with one byte.
constexpr std::size_t gif_block = 255;
std::string gif_with(std::string file, std::string_view note) {
  if (file.empty() || file.back() != ';') return file;
  std::string comment = "\x21\xFE";
  for (std::size_t i = 0; i < note.size(); i += gif_block) {
    const std::string_view block = note.substr(i, gif_block);
    comment += static_cast<char>(block.size());
    comment += block;
  }
  comment += '\0';
  return file.insert(file.size() - 1, comment);
}
std::string from_gif(std::string_view file, std::size_t note) {
  std::string text;
  for (std::size_t at = note - 1; at < file.size();) {
    const std::size_t size = static_cast<unsigned char>(file[at]);
    if (size == 0 || at + 1 + size > file.size()) break;
    text += file.substr(at + 1, size);
    at += 1 + size;
  }
  return text;
}

// The JSON object that a text begins with.
std::string first_object(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && c == '{')
      ++depth;
    else if (!quoted && c == '}' && --depth == 0)
      return std::string(text.substr(0, i + 1));
  }
  return "";
}

struct Format {
  std::string_view extension;
  std::string (*add)(std::string, std::string_view);
};
constexpr Format formats[] = {{".png", png_with}, {".svg", svg_with},   {".pdf", pdf_with},
                              {".glb", glb_with}, {".html", html_with}, {".webp", webp_with},
                              {".gif", gif_with}};

}  // namespace

bool takes_note(std::string_view extension) {
  return extension == ".mp4" ||
         std::ranges::any_of(formats, [&](const Format& f) { return f.extension == extension; });
}

std::string with_note(std::string file, std::string_view extension, std::string_view note) {
  for (const Format& format : formats)
    if (format.extension == extension) return format.add(std::move(file), note);
  return file;
}

std::string note_in(std::string_view file, std::string_view extension) {
  const std::size_t at = file.find(note_begin);
  if (at == std::string_view::npos || at == 0) return "";
  if (extension == ".pdf") return first_object(from_pdf(file.substr(at)));
  if (extension == ".gif") return first_object(from_gif(file, at));
  return first_object(file.substr(at));
}

std::string sealed(std::string file, std::string_view extension) {
  const std::size_t at = file.find(note_begin);
  if (at == std::string::npos || at < 16 || at + note_begin.size() + checksum_digits > file.size())
    return file;
  const auto put = [&](const std::string& digits) {
    file.replace(at + note_begin.size(), checksum_digits, digits);
    if (extension == ".png") renew_png_chunk(file, at);
  };
  put(std::string(checksum_digits, '0'));
  Checksum sum;
  sum.add(file);
  put(sum.text());
  return file;
}

}  // namespace unfurl
