// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace unfurl {

// Remove the files that are being written (atomic_file.hpp), for a handler that ends the program at once:
// nothing but unlink() is called, and a file that gets its name meanwhile keeps it. Of more than 32 some
// stay, as do names of more than 1023 bytes.
void remove_pending_files() noexcept;

}  // namespace unfurl
