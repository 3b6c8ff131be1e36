// unfurl view [SCENE]: the interactive window.
#include "app/command.hpp"
#include "app/window/window.hpp"

namespace unfurl {

int cmd_view(const Arguments& arguments) {
  const std::string scene = arguments.names.empty() ? "hoop6" : arguments.names.front();
  SceneDocument document = open_document(scene, arguments.overrides);
  read_document(document);  // what is wrong with the scene is said here, before a window opens
  WindowOptions options;
  options.ui_scale = static_cast<float>(arguments.ui_scale);
  return show_window(std::move(document), options);
}

}  // namespace unfurl
