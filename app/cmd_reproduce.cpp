#include "app/command.hpp"
namespace unfurl {
int cmd_reproduce(const Arguments&) {
  return 0;
}
}  // namespace unfurl
