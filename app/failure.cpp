#include "app/failure.hpp"

#include <exception>
#include <new>

#include "app/exit_code.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/reader.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {

int report_failure(std::ostream& out) {
  try {
    throw;
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
