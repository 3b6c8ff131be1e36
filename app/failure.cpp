// SPDX-License-Identifier: BSD-3-Clause
#include "app/failure.hpp"

#include <unistd.h>

#include <exception>
#include <new>
#include <string_view>

#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/reader.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "render/gl/graphics_error.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {

namespace {

// Memory that runs out where no exception may pass (in a destructor, in a library): one line, as anywhere
// else, and no memory is asked for it.
[[noreturn]] void end_with_a_line() {
  std::string_view line = "unfurl: internal error\n";
  try {
    throw;
  } catch (const std::bad_alloc&) {
    line = "unfurl: out of memory\n";
  } catch (...) {
  }
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
  end_children();
  ::_exit(exit_internal);
}

}  // namespace

void end_in_words() {
  std::set_terminate(end_with_a_line);
}

int report_failure(std::ostream& out) {
  constexpr const char* interrupted_words = "unfurl: interrupted; what is finished is kept\n";
  try {
    throw;
  } catch (const Interrupted&) {
    out << interrupted_words;
    return exit_interrupted;
  } catch (const Cancelled&) {
    out << interrupted_words;
    return exit_interrupted;
  } catch (const SceneError& error) {
    out << error.what() << "\n";
    return exit_scene_invalid;
  } catch (const UsageError& error) {
    out << "unfurl: " << error.what() << "\n";
    return exit_usage;
  } catch (const ReferenceError& error) {
    out << "unfurl: " << error.what() << "\n";
    return exit_solver_failed;
  } catch (const JournalMismatch& error) {
    out << "unfurl: " << error.what() << "\n";
    return exit_file_error;
  } catch (const UnreadableScene& error) {
    out << "unfurl: " << error.what() << "\n";
    return exit_file_error;
  } catch (const FileError& error) {
    out << "unfurl: " << error.what() << "\n";
    return exit_file_error;
  } catch (const GraphicsError& error) {
    out << "unfurl: " << error.what() << "\n";
    return exit_no_graphics;
  } catch (const std::bad_alloc&) {
    out << "unfurl: out of memory\n";
  } catch (const std::exception& error) {
    out << "unfurl: internal error: " << error.what() << "\n";
  } catch (...) {
    out << "unfurl: internal error\n";
  }
  return exit_internal;
}

}  // namespace unfurl
