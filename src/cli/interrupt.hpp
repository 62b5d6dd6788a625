// SPDX-License-Identifier: MIT
/// What does Ctrl-C do? It ends the program with exit code 130, one line and nothing half written; work on a
/// queue that can be interrupted is cancelled first, so that the device has its memory back. A second one
/// ends the program at once.
#pragma once

#include "setka/device.hpp"

namespace setka::cli {

/// From here on an interrupt is answered, unless whoever started the program had it ignored. Called once.
void listen_for_interrupts();

/// A queue whose work the first interrupt cancels. Until this is called, an interrupt ends the program.
[[nodiscard]] Queue make_interruptible_queue(const Device& device);

/// The work is done; what follows on the host is ended rather than cancelled. Throws Cancelled if the
/// interrupt came before.
void end_interruptible_work();

}  // namespace setka::cli
