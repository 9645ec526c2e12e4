/* OpenEXR behind a C interface, through the library's C++ one: the C interface of Debian's version
 * cannot read DWA, and its RGBA classes go through half floats, which real skies exceed. */
#include "image.h"

#include "file.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTestFile.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using Imath::Box2i;

const int max_channels = 64;

struct frame {
    rd_image_f32* image;
    Box2i window;
};

/* Throws what the reader below reports as "FILE: reason". */
[[noreturn]] void refuse(const char* why)
{
    throw std::runtime_error(why);
}

void check_window(const Box2i& w)
{
    const int64_t width = int64_t(w.max.x) - w.min.x + 1;
    const int64_t height = int64_t(w.max.y) - w.min.y + 1;
    if (width < 1 || height < 1 || width > RD_IMAGE_MAX_SIDE || height > RD_IMAGE_MAX_SIDE ||
        width * height > int64_t(RD_IMAGE_MAX_PIXELS)) {
        refuse("unusable data window");
    }
}

void check_channels(const Imf::ChannelList& channels)
{
    int count = 0;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        if (++count > max_channels) {
            refuse("too many channels");
        }
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
            refuse("has subsampled channels (luminance/chroma), which are not read");
        }
    }
}

void allocate(rd_image_f32* image)
{
    const size_t pixels = size_t(image->width) * size_t(image->height);
    image->rgba = static_cast<float*>(std::malloc(pixels * 4 * sizeof(float)));
    if (!image->rgba) {
        refuse("out of memory");
    }
    for (size_t i = 0; i < pixels * 4; ++i) {
        image->rgba[i] = (i & 3) == 3 ? 1.0f : 0.0f;
    }
}

/* The library addresses pixel (x, y) as base + x * 16 + y * 16 * width in window coordinates. */
Imf::Slice slice(const frame& f, int component)
{
    const ptrdiff_t x_stride = 4 * sizeof(float);
    const ptrdiff_t y_stride = x_stride * f.image->width;
    char* base = reinterpret_cast<char*>(f.image->rgba + component);
    base -= f.window.min.x * x_stride + f.window.min.y * y_stride;
    return Imf::Slice(Imf::FLOAT, base, size_t(x_stride), size_t(y_stride));
}

/* A file with a single colour channel, whatever its name, is grey: fills G and B from R. */
const char* grey_channel(const Imf::ChannelList& channels)
{
    const char* only = nullptr;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        if (std::strcmp(c.name(), "A") != 0) {
            if (only) {
                return nullptr;
            }
            only = c.name();
        }
    }
    return only;
}

void copy_grey(rd_image_f32* image)
{
    const size_t pixels = size_t(image->width) * size_t(image->height);
    for (size_t i = 0; i < pixels; ++i) {
        float* p = image->rgba + i * 4;
        p[1] = p[2] = p[0];
    }
}

void read_pixels(Imf::InputFile& file, rd_image_f32* image, const Box2i& window)
{
    const Imf::ChannelList& channels = file.header().channels();
    const char* grey = grey_channel(channels);
    const frame f = {image, window};
    Imf::FrameBuffer buffer;
    if (grey) {
        buffer.insert(grey, slice(f, 0));
    } else if (channels.findChannel("R") || channels.findChannel("G") ||
               channels.findChannel("B")) {
        buffer.insert("R", slice(f, 0));
        buffer.insert("G", slice(f, 1));
        buffer.insert("B", slice(f, 2));
    } else {
        refuse("has neither R, G, B nor a single channel");
    }
    if (channels.findChannel("A")) {
        buffer.insert("A", slice(f, 3));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (grey) {
        copy_grey(image);
    }
}

rd_image_layout layout_of(const Imf::Header& header)
{
    if (!Imf::hasEnvmap(header)) {
        return RD_LAYOUT_PLAIN;
    }
    return Imf::envmap(header) == Imf::ENVMAP_CUBE ? RD_LAYOUT_CUBE : RD_LAYOUT_LATLONG;
}

/* The first chunks of a damaged file may claim anything: refuse before the library believes it. */
void check_kind(const char* path)
{
    bool tiled = false, deep = false, multipart = false;
    if (!Imf::isOpenExrFile(path, tiled, deep, multipart)) {
        refuse("not an OpenEXR file");
    }
    if (deep || multipart) {
        refuse(deep ? "deep images are not read" : "multi-part files are not read");
    }
}

void read(rd_image_f32* image, const char* path)
{
    Imf::Header::setMaxImageSize(RD_IMAGE_MAX_SIDE, RD_IMAGE_MAX_SIDE);
    Imf::Header::setMaxTileSize(4096, 4096);
    check_kind(path);
    Imf::InputFile file(path, 0);
    const Imf::Header& header = file.header();
    const Box2i window = header.dataWindow();
    check_window(window);
    check_channels(header.channels());
    if (!file.isComplete()) {
        refuse("is incomplete");
    }
    image->width = window.max.x - window.min.x + 1;
    image->height = window.max.y - window.min.y + 1;
    image->layout = layout_of(header);
    allocate(image);
    read_pixels(file, image, window);
}

void write(const char* path, int width, int height, const float* rgba)
{
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    const char* const names[4] = {"R", "G", "B", "A"};
    char* base = reinterpret_cast<char*>(const_cast<float*>(rgba));
    for (int c = 0; c < 4; ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base + c * int(sizeof(float)),
                                           4 * sizeof(float), size_t(width) * 4 * sizeof(float)));
    }
    Imf::OutputFile file(path, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(height);
}

/* The library says `... "PATH". Reason.`, sometimes in several lines: keep the reason. */
bool fail_with(rd_report* report, const char* path, const char* message)
{
    const std::string text(message);
    const std::string quoted = "\"" + std::string(path) + "\". ";
    const size_t at = text.find(quoted);
    return rd_fail(report, path, "%s",
                   text.c_str() + (at == std::string::npos ? 0 : at + quoted.size()));
}

} // namespace

bool rd_image_read_exr(rd_image_f32* image, const char* path, rd_report* report)
{
    std::memset(image, 0, sizeof *image);
    try {
        read(image, path);
        return true;
    } catch (const std::exception& e) {
        fail_with(report, path, e.what());
    } catch (...) {
        rd_fail(report, path, "unknown failure of the OpenEXR library");
    }
    rd_image_free_f32(image);
    return false;
}

bool rd_image_write_exr(const char* path, int width, int height, const float* rgba,
                        rd_report* report)
{
    rd_output out;
    bool ok = true;
    if (!rd_output_begin(&out, path, report)) {
        return false;
    }
    try {
        write(out.temporary, width, height, rgba);
    } catch (const std::exception& e) {
        ok = fail_with(report, path, e.what());
    } catch (...) {
        ok = rd_fail(report, path, "unknown failure of the OpenEXR library");
    }
    return rd_output_end(&out, ok, report);
}
