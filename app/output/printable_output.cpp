// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/printable_output.hpp"

#include <streambuf>
#include <string>
#include <string_view>

#include "core/text/xml_text.hpp"

namespace unfurl {

class PrintableOutput::Filter : public std::streambuf {
 public:
  explicit Filter(std::streambuf* target) : target_(target) {}

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return sync() == 0 ? 0 : c;
    const char one = traits_type::to_char_type(c);
    return xsputn(&one, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    waiting_.append(text, static_cast<std::size_t>(size));
    const std::size_t end = waiting_.rfind('\n');
    return end == std::string::npos || pass_on(end + 1) ? size : 0;
  }
  int sync() override { return pass_on(waiting_.size()) ? target_->pubsync() : -1; }

 private:
  // So many bytes: whole lines, or all there is, so that no character is cut in two.
  bool pass_on(std::size_t size) {
    const std::string text = printable_text(std::string_view(waiting_).substr(0, size));
    waiting_.erase(0, size);
    const auto length = static_cast<std::streamsize>(text.size());
    return target_->sputn(text.data(), length) == length;
  }

  std::streambuf* target_;
  std::string waiting_;
};

PrintableOutput::PrintableOutput(std::ostream& stream)
    : stream_(stream), filter_(std::make_unique<Filter>(stream.rdbuf())), before_(stream.rdbuf()) {
  replace(filter_.get());
}

PrintableOutput::~PrintableOutput() {
  stream_.flush();
  replace(before_);
}

// What went wrong before is not forgotten with the buffer.
void PrintableOutput::replace(std::streambuf* buffer) {
  const auto state = stream_.rdstate();
  stream_.rdbuf(buffer);
  stream_.setstate(state);
}

}  // namespace unfurl
