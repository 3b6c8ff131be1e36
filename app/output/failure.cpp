// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/failure.hpp"

#include <unistd.h>

#include <exception>
#include <new>
#include <string_view>

#include "app/output/exit_code.hpp"
#include "app/output/interrupt.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/reader.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "core/study/solve_for.hpp"
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

template <class... Kinds>
bool is_any(const Error& error) {
  return (... || (dynamic_cast<const Kinds*>(&error) != nullptr));
}

// For scripts: what kind of thing a person has to mend.
int exit_code_of(const Error& error) {
  if (is_any<SceneError>(error)) return exit_scene_invalid;
  if (is_any<UsageError, StudyError>(error)) return exit_usage;
  if (is_any<ReferenceError, NotFound>(error)) return exit_solver_failed;
  if (is_any<FileError, UnreadableScene, JournalMismatch>(error)) return exit_file_error;
  if (is_any<GraphicsError>(error)) return exit_no_graphics;
  return exit_scene_invalid;  // an impossible structure
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
  } catch (const Error& error) {
    const int code = exit_code_of(error);
    out << (code == exit_scene_invalid ? "" : "unfurl: ") << error.what()
        << "\n";  // a scene's begin with its place
    return code;
  } catch (const std::bad_alloc&) {
    out << "unfurl: out of memory\n";
  } catch (const std::system_error& error) {
    const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
    out << (no_thread ? "unfurl: no thread can be started (a limit on processes?): "
                      : "unfurl: internal error: ")
        << error.what() << "\n";
  } catch (const std::exception& error) {
    out << "unfurl: internal error: " << error.what() << "\n";
  } catch (...) {
    out << "unfurl: internal error\n";
  }
  return exit_internal;
}

}  // namespace unfurl
