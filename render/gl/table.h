// Table of the OpenGL 3.3 core functions in use, loaded per context at run time. No GL library is
// linked, so EGL and OSMesa can be used in one process without symbol conflicts.
#pragma once

#include <GL/glcorearb.h>

namespace sunder::render {

// clang-format off
#define SUNDER_GL_FUNCTIONS(F)                                                                   \
  F(ACTIVETEXTURE, ActiveTexture) F(ATTACHSHADER, AttachShader) F(BINDBUFFER, BindBuffer)        \
  F(BINDBUFFERBASE, BindBufferBase) F(BINDFRAMEBUFFER, BindFramebuffer)                          \
  F(BINDTEXTURE, BindTexture) F(BINDVERTEXARRAY, BindVertexArray)                                \
  F(BLENDFUNCSEPARATE, BlendFuncSeparate) F(BUFFERDATA, BufferData)                              \
  F(BUFFERSUBDATA, BufferSubData) F(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus)              \
  F(CLEAR, Clear) F(CLEARCOLOR, ClearColor) F(COLORMASK, ColorMask)                              \
  F(COMPILESHADER, CompileShader) F(CREATEPROGRAM, CreateProgram)                                \
  F(CREATESHADER, CreateShader) F(CULLFACE, CullFace) F(DELETESHADER, DeleteShader)              \
  F(DEPTHFUNC, DepthFunc) F(DEPTHMASK, DepthMask) F(DISABLE, Disable)                            \
  F(DRAWARRAYS, DrawArrays) F(DRAWARRAYSINSTANCED, DrawArraysInstanced)                          \
  F(DRAWBUFFERS, DrawBuffers) F(DRAWELEMENTS, DrawElements) F(ENABLE, Enable)                    \
  F(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) F(FINISH, Finish)                          \
  F(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D) F(GENBUFFERS, GenBuffers)                        \
  F(GENFRAMEBUFFERS, GenFramebuffers) F(GENTEXTURES, GenTextures)                                \
  F(GENVERTEXARRAYS, GenVertexArrays) F(GENERATEMIPMAP, GenerateMipmap)                          \
  F(GETERROR, GetError) F(GETINTEGERV, GetIntegerv) F(GETPROGRAMIV, GetProgramiv)                \
  F(GETPROGRAMINFOLOG, GetProgramInfoLog) F(GETSHADERIV, GetShaderiv)                            \
  F(GETSHADERINFOLOG, GetShaderInfoLog) F(GETSTRING, GetString)                                  \
  F(GETUNIFORMBLOCKINDEX, GetUniformBlockIndex) F(GETUNIFORMLOCATION, GetUniformLocation)        \
  F(LINKPROGRAM, LinkProgram) F(MULTIDRAWELEMENTS, MultiDrawElements)                            \
  F(PIXELSTOREI, PixelStorei) F(POLYGONMODE, PolygonMode) F(POLYGONOFFSET, PolygonOffset)        \
  F(READBUFFER, ReadBuffer) F(READPIXELS, ReadPixels) F(SHADERSOURCE, ShaderSource)              \
  F(TEXBUFFER, TexBuffer) F(TEXIMAGE2D, TexImage2D) F(TEXIMAGE3D, TexImage3D)                    \
  F(TEXPARAMETERFV, TexParameterfv) F(TEXPARAMETERI, TexParameteri)                              \
  F(UNIFORM1I, Uniform1i) F(UNIFORMBLOCKBINDING, UniformBlockBinding) F(USEPROGRAM, UseProgram)  \
  F(VERTEXATTRIBDIVISOR, VertexAttribDivisor)                                                    \
  F(VERTEXATTRIBIPOINTER, VertexAttribIPointer) F(VERTEXATTRIBPOINTER, VertexAttribPointer)      \
  F(VIEWPORT, Viewport)
// clang-format on

/// The functions of one context: `gl.Clear(...)` is its glClear.
struct GlTable {
#define SUNDER_GL_MEMBER(TYPE, NAME) PFNGL##TYPE##PROC NAME = nullptr;
  SUNDER_GL_FUNCTIONS(SUNDER_GL_MEMBER)
#undef SUNDER_GL_MEMBER
};

using GlProcedure = void (*)();

/// Fills the table by `procedure(name)`. Returns the name of the first missing function, or null.
template <class Procedure>
const char* fill(GlTable& gl, const Procedure& procedure) {
  const char* missing = nullptr;
#define SUNDER_GL_LOAD(TYPE, NAME)                                      \
  gl.NAME = reinterpret_cast<PFNGL##TYPE##PROC>(procedure("gl" #NAME)); \
  if (gl.NAME == nullptr && missing == nullptr) missing = "gl" #NAME;
  SUNDER_GL_FUNCTIONS(SUNDER_GL_LOAD)
#undef SUNDER_GL_LOAD
  return missing;
}

}  // namespace sunder::render
