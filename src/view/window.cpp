// SPDX-License-Identifier: MIT
#include "view/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GL/gl.h>
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

#include "setka/error.hpp"
#include "view/style.hpp"

namespace setka::view {

namespace {

std::string reason() {
    const char* text = nullptr;
    return glfwGetError(&text) == GLFW_NO_ERROR || !text ? "no reason is known" : text;
}

}  // namespace

struct Window::Library {
    Library() {
        if (glfwInit() != GLFW_TRUE) throw Error(ErrorCategory::Unsupported, "no display: " + reason());
    }
    ~Library() { glfwTerminate(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
};

Window::Window(WindowSize size, const std::string& title) : library_(std::make_shared<Library>()) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    glfwWindowHint(GLFW_SRGB_CAPABLE, GLFW_FALSE);  // codes are shown as they are
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (!window_) throw Error(ErrorCategory::Unsupported, "no display with OpenGL 3.0: " + reason());
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // nothing is written beside the scene
    set_style();
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 130");
    glGenTextures(1, &texture_);
}

Window::~Window() {
    glDeleteTextures(1, &texture_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
}

void Window::begin_frame(double wait_seconds) {
    if (wait_seconds > 0) glfwWaitEventsTimeout(wait_seconds);
    else glfwPollEvents();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::draw() const {
    ImGui::Render();
    const WindowSize now = size();
    glViewport(0, 0, now.width, now.height);
    glClearColor(0.07f, 0.07f, 0.08f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::end_frame() {
    draw();
    glfwSwapBuffers(window_);
}

Image Window::capture() {
    draw();
    const WindowSize now = size();
    Image image;
    image.width = static_cast<std::uint32_t>(now.width);
    image.height = static_cast<std::uint32_t>(now.height);
    image.srgb.resize(std::size_t(3) * image.width * image.height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, now.width, now.height, GL_RGB, GL_UNSIGNED_BYTE, image.srgb.data());
    const std::size_t row = std::size_t(3) * image.width;
    for (std::uint32_t y = 0; y < image.height / 2; ++y)
        std::swap_ranges(image.srgb.begin() + y * row, image.srgb.begin() + (y + 1) * row,
                         image.srgb.begin() + (image.height - 1 - y) * row);
    glfwSwapBuffers(window_);
    return image;
}

void Window::wake() { glfwPostEmptyEvent(); }

bool Window::is_closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

WindowSize Window::size() const {
    WindowSize now;
    glfwGetFramebufferSize(window_, &now.width, &now.height);
    return now;
}

void Window::resize(WindowSize size) { glfwSetWindowSize(window_, size.width, size.height); }

bool Window::is_down(char letter) const {
    return !ImGui::GetIO().WantTextInput && glfwGetKey(window_, letter) == GLFW_PRESS;
}

void Window::set_picture(const Image& image, Enlarged enlarged) {
    const GLint filter = enlarged == Enlarged::Smooth ? GL_LINEAR : GL_NEAREST;
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S,
                    0x812F);  // GL_CLAMP_TO_EDGE, newer than <GL/gl.h> need be
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, 0x812F);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, static_cast<GLsizei>(image.width),
                 static_cast<GLsizei>(image.height), 0, GL_RGB, GL_UNSIGNED_BYTE, image.srgb.data());
}

void* Window::picture_id() const { return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture_)); }

}  // namespace setka::view
