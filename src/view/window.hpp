// SPDX-License-Identifier: MIT
/// What is the window made of? GLFW for the window and what is typed, OpenGL for its pixels, Dear ImGui for
/// what is drawn. The only files that know the first two.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "setka/image.hpp"

struct GLFWwindow;

namespace setka::view {

struct WindowSize {
    int width = 0, height = 0;
    friend bool operator==(const WindowSize&, const WindowSize&) = default;
};

class Window {
  public:
    /// Throws Unsupported, starting with "no display", where no window can be opened.
    Window(WindowSize size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Takes what was typed since the last call, waiting for it up to that long, and begins a frame of ImGui.
    void begin_frame(double wait_seconds);
    /// Draws it, and shows it.
    void end_frame();
    /// What was drawn since begin_frame(), with the frame of ImGui ended: rows from the top. end_frame() is
    /// not called then.
    [[nodiscard]] Image capture();
    /// Ends a wait in begin_frame(); for any thread.
    static void wake();

    [[nodiscard]] bool is_closing() const;
    [[nodiscard]] WindowSize size() const;  ///< in pixels
    void resize(WindowSize size);
    /// Whether a letter's key is held down, and nobody types text.
    [[nodiscard]] bool is_down(char letter) const;

    /// Pixels for picture_id(): an 8-bit picture. Sharp, one that is shown in its own size keeps every byte.
    enum class Enlarged { Sharp, Smooth };
    void set_picture(const Image& image, Enlarged enlarged);
    [[nodiscard]] void* picture_id() const;

  private:
    struct Library;
    void draw() const;

    std::shared_ptr<Library> library_;
    GLFWwindow* window_ = nullptr;
    std::uint32_t texture_ = 0;
};

}  // namespace setka::view
