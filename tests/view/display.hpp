// SPDX-License-Identifier: MIT
/// Where is there a display for a test? In an Xvfb of its own, which ends with the test.
#pragma once

#include <sys/types.h>

#include <string>

namespace view_test {

class Display {
  public:
    /// Starts Xvfb; without one, name() is empty and trouble() says why.
    Display();
    ~Display();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    [[nodiscard]] const std::string& name() const { return name_; }  ///< ":7"
    [[nodiscard]] const std::string& trouble() const { return trouble_; }

  private:
    pid_t server_ = -1;
    std::string name_, trouble_;
};

}  // namespace view_test
