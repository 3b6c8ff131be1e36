// SPDX-License-Identifier: BSD-3-Clause
// A note inside a file: where each format keeps text that its readers leave alone, and a checksum of all the
// rest.
#pragma once

#include <string>
#include <string_view>

namespace unfurl {

// How a note begins; its checksum's digits follow at once, and it is one JSON object of ASCII characters
// without
// <, > and &, so that it may stand anywhere.
inline constexpr std::string_view note_begin = R"({"unfurl_receipt":1,"checksum":")";
inline constexpr std::size_t checksum_digits = 16;

// Formats that take a note, by extension (".png"): PNG (tEXt), SVG (metadata), PDF (document information),
// glTF (asset.extras), HTML (a script that is data), WebP (XMP), GIF (comment). MP4 comes with it from its
// encoder.
bool takes_note(std::string_view extension);
// The whole file with the note in its place, as it stands where the format is not understood.
std::string with_note(std::string file, std::string_view extension, std::string_view note);
// The note in a file; empty where there is none.
std::string note_in(std::string_view file, std::string_view extension);
// The file with the checksum of its bytes, that of the digits themselves counted as zeros. A file that was
// not changed since is its own sealed copy.
std::string sealed(std::string file, std::string_view extension);

}  // namespace unfurl
