// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

namespace unfurl {

// A linked pair of shaders (#version 330 core). Needs a current context from construction to destruction.
class Program {
 public:
  // `name` is for messages. Throws GraphicsError with the driver's log where the sources do not compile or
  // link.
  Program(const std::string& name, const std::string& vertex_source, const std::string& fragment_source);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const;
  // Set a uniform of the program in use; a name that the driver optimised away is ignored.
  void set(const char* name, int value) const;
  void set(const char* name, float value) const;
  void set(const char* name, const Eigen::Vector2f& value) const;
  void set(const char* name, const Eigen::Vector3f& value) const;
  void set(const char* name, const Eigen::Vector4f& value) const;
  void set(const char* name, const Eigen::Matrix4f& value) const;

 private:
  int location(const char* name) const;
  unsigned program_ = 0;
};

}  // namespace unfurl
