// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl/program.hpp"

#include <vector>

#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {
namespace {

using GetParameter = PFNGLGETSHADERIVPROC;  // programs have the same signatures
using GetLog = PFNGLGETSHADERINFOLOGPROC;

// Throws unless the status `which` of the shader or program is good.
void require(unsigned object, GLenum which, GetParameter parameter, GetLog log, const std::string& name) {
  int good = 0, length = 0;
  parameter(object, which, &good);
  if (good) return;
  parameter(object, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> text(static_cast<std::size_t>(length) + 1, '\0');
  log(object, length, nullptr, text.data());
  throw GraphicsError("cannot draw: this OpenGL refuses the shader '" + name + "': " + text.data());
}

// Compile and attach; the program keeps the shader alive, so that it goes with it.
void attach(unsigned program, GLenum stage, const std::string& source, const std::string& name) {
  const unsigned shader = gl::CreateShader(stage);
  gl::AttachShader(program, shader);
  gl::DeleteShader(shader);
  const char* text = source.c_str();
  gl::ShaderSource(shader, 1, &text, nullptr);
  gl::CompileShader(shader);
  require(shader, GL_COMPILE_STATUS, gl::GetShaderiv, gl::GetShaderInfoLog, name);
}

}  // namespace

Program::Program(const std::string& name, const std::string& vertex_source,
                 const std::string& fragment_source)
    : program_(gl::CreateProgram()) {
  try {
    attach(program_, GL_VERTEX_SHADER, vertex_source, name + ", vertex stage");
    attach(program_, GL_FRAGMENT_SHADER, fragment_source, name + ", fragment stage");
    gl::LinkProgram(program_);
    require(program_, GL_LINK_STATUS, gl::GetProgramiv, gl::GetProgramInfoLog, name);
  } catch (...) {
    gl::DeleteProgram(program_);
    throw;
  }
}

Program::~Program() {
  gl::DeleteProgram(program_);
}

void Program::use() const {
  gl::UseProgram(program_);
}

int Program::location(const char* name) const {
  return gl::GetUniformLocation(program_, name);
}

void Program::set(const char* name, int value) const {
  gl::Uniform1i(location(name), value);
}
void Program::set(const char* name, float value) const {
  gl::Uniform1f(location(name), value);
}
void Program::set(const char* name, const Eigen::Vector2f& value) const {
  gl::Uniform2f(location(name), value.x(), value.y());
}
void Program::set(const char* name, const Eigen::Vector3f& value) const {
  gl::Uniform3f(location(name), value.x(), value.y(), value.z());
}
void Program::set(const char* name, const Eigen::Vector4f& value) const {
  gl::Uniform4f(location(name), value.x(), value.y(), value.z(), value.w());
}
void Program::set(const char* name, const Eigen::Matrix4f& value) const {
  gl::UniformMatrix4fv(location(name), 1, GL_FALSE, value.data());
}

}  // namespace unfurl
