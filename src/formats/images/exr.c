// SPDX-License-Identifier: MIT
// OpenEXR images, by OpenEXRCore over memory: reads one part of scanlines or tiles, half or float;
// writes scanlines of floats or halves, ZIP.
#include "formats/images/images.h"

#include "base/half.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <openexr.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/// No compression that OpenEXRCore reads packs more than zlib's 1032 bytes into one; a header that
/// promises more is not believed, so that a short file cannot ask for gigabytes.
enum { MOST_BYTES_PER_BYTE = 1100 };

/// Attribute of ours: what 1 stands for, a float.
#define SCALE_NAME "alpenglowScale"

/// What the library's callbacks reach: the bytes, and the first message it gave.
typedef struct exr_stream {
    alp_context *context;
    const uint8_t *input; // reading
    uint8_t *output;      // writing
    size_t size, capacity;
    bool out_of_memory, cancelled;
    char message[160];
} exr_stream;

static exr_stream *stream_of(exr_const_context_t exr)
{
    void *user = NULL;
    return exr_get_user_data(exr, &user) == EXR_ERR_SUCCESS ? user : NULL;
}

static void keep_message(exr_const_context_t exr, exr_result_t code, const char *message)
{
    (void)code;
    exr_stream *stream = stream_of(exr);
    if (stream != NULL && stream->message[0] == '\0') {
        snprintf(stream->message, sizeof stream->message, "%s", message);
    }
}

static int64_t read_bytes(exr_const_context_t exr, void *user, void *buffer, uint64_t size,
                          uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    (void)exr;
    (void)fail; // a short read is reported by the library
    const exr_stream *stream = user;
    if (offset >= stream->size) {
        return 0;
    }
    uint64_t left = stream->size - offset;
    size_t count = (size_t)(size < left ? size : left);
    memcpy(buffer, stream->input + offset, count);
    return (int64_t)count;
}

static int64_t query_size(exr_const_context_t exr, void *user)
{
    (void)exr;
    return (int64_t)((const exr_stream *)user)->size;
}

static int64_t write_bytes(exr_const_context_t exr, void *user, const void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    (void)exr;
    (void)fail;
    exr_stream *stream = user;
    uint64_t end = offset + size;
    if (alpi_grow(stream->context, (void **)&stream->output, &stream->capacity, (size_t)end, 1) !=
        ALP_OK) {
        stream->out_of_memory = true;
        return -1;
    }
    memcpy(stream->output + offset, buffer, (size_t)size);
    stream->size = end > stream->size ? (size_t)end : stream->size;
    return (int64_t)size;
}

static exr_context_initializer_t initializer(exr_stream *stream)
{
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    options.error_handler_fn = keep_message; // the default one prints
    options.user_data = stream;
    options.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return options;
}

static alp_result fail_exr(const exr_stream *stream, const char *name, exr_result_t code)
{
    alp_result result = ALP_ERROR_INVALID_DATA;
    if (code == EXR_ERR_OUT_OF_MEMORY || stream->out_of_memory) {
        result = ALP_ERROR_OUT_OF_MEMORY;
    } else if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED) {
        result = ALP_ERROR_UNSUPPORTED;
    }
    return alpi_fail(stream->context, result, "%s: not readable as OpenEXR: %s", name,
                     stream->message[0] ? stream->message : exr_get_default_error_message(code));
}

#define TRY_EXR(reader, expr)                                                                      \
    do {                                                                                           \
        exr_result_t code_ = (expr);                                                               \
        if (code_ != EXR_ERR_SUCCESS) {                                                            \
            return fail_exr((reader)->stream, (reader)->name, code_);                              \
        }                                                                                          \
    } while (0)

// --- reading -------------------------------------------------------------------------------------

typedef struct exr_reader {
    exr_stream *stream;
    const char *name;
    exr_context_t exr;
    exr_attr_box2i_t window;
    const char *const *channels; // file's name of each channel of the image
    alp_image *image;
    exr_decode_pipeline_t decode;
    bool decoding; // `decode` was initialised
    float *planes; // one chunk, channel after channel, then one for all others
} exr_reader;

static const char *const GREY[] = {"Y", "A"};
static const char *const COLOR[] = {"R", "G", "B", "A"};

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        if (strcmp(list->entries[i].name.str, name) == 0) {
            return &list->entries[i];
        }
    }
    return NULL;
}

/// Which of the file's channels make the image. @param count out: channels of the image
static alp_result choose_channels(exr_reader *reader, uint32_t *count)
{
    alp_context *context = reader->stream->context;
    const exr_attr_chlist_t *list = NULL;
    TRY_EXR(reader, exr_get_channels(reader->exr, 0, &list));
    bool color = find_channel(list, "R") && find_channel(list, "G") && find_channel(list, "B");
    if (!color && find_channel(list, "Y") == NULL) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                         "%s: has neither channels R, G, B nor Y (its first of %d is \"%s\")",
                         reader->name, list->num_channels,
                         list->num_channels > 0 ? list->entries[0].name.str : "");
    }
    reader->channels = color ? COLOR : GREY;
    *count = (color ? 3u : 1u) + (find_channel(list, "A") != NULL);
    for (uint32_t k = 0; k < *count; k++) {
        const exr_attr_chlist_entry_t *entry = find_channel(list, reader->channels[k]);
        if (entry->x_sampling != 1 || entry->y_sampling != 1) {
            return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                             "%s: channel %s is subsampled; store it at full resolution",
                             reader->name, reader->channels[k]);
        }
        if (entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT) {
            return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                             "%s: channel %s holds integers; half or float is needed", reader->name,
                             reader->channels[k]);
        }
    }
    return ALP_OK;
}

/// Refuses by name what OpenEXRCore cannot decode or we do not read.
static alp_result check_kind(const exr_reader *reader)
{
    int parts = 0;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    TRY_EXR(reader, exr_get_count(reader->exr, &parts));
    TRY_EXR(reader, exr_get_storage(reader->exr, 0, &storage));
    TRY_EXR(reader, exr_get_compression(reader->exr, 0, &compression));
    const char *fault = NULL;
    if (parts != 1) {
        fault = "has several parts; store one part";
    } else if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
        fault = "holds deep data; flatten it";
    } else if (compression == EXR_COMPRESSION_DWAA) {
        fault = "DWAA compression is not supported; convert it to ZIP";
    } else if (compression == EXR_COMPRESSION_DWAB) {
        fault = "DWAB compression is not supported; convert it to ZIP";
    }
    return fault == NULL ? ALP_OK
                         : alpi_fail(reader->stream->context, ALP_ERROR_UNSUPPORTED, "%s: %s",
                                     reader->name, fault);
}

/// Bytes of a pixel over all channels of the file, wanted or not; at most what any stores.
static uint64_t stored_pixel_size(const exr_attr_chlist_t *list)
{
    uint64_t size = 0;
    for (int i = 0; i < list->num_channels; i++) {
        if (list->entries[i].x_sampling == 1 && list->entries[i].y_sampling == 1) {
            size += list->entries[i].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
        }
    }
    return size;
}

static alp_result create_image(exr_reader *reader, uint32_t channels)
{
    alp_context *context = reader->stream->context;
    TRY_EXR(reader, exr_get_data_window(reader->exr, 0, &reader->window));
    int64_t width = (int64_t)reader->window.max.x - reader->window.min.x + 1;
    int64_t height = (int64_t)reader->window.max.y - reader->window.min.y + 1;
    if (width < 1 || height < 1) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA, "%s: its data window is empty",
                         reader->name);
    }
    if (width > ALPI_IMAGE_SIDE_LIMIT || height > ALPI_IMAGE_SIDE_LIMIT ||
        (uint64_t)(width * height) > ALPI_IMAGE_PIXEL_LIMIT) {
        return alpi_fail(context, ALP_ERROR_LIMIT,
                         "%s: %lld x %lld pixels; the limits are 2^28, and %d in a row",
                         reader->name, (long long)width, (long long)height, ALPI_IMAGE_SIDE_LIMIT);
    }
    const exr_attr_chlist_t *list = NULL;
    TRY_EXR(reader, exr_get_channels(reader->exr, 0, &list));
    uint64_t promised = (uint64_t)(width * height) * stored_pixel_size(list);
    if (promised / MOST_BYTES_PER_BYTE > reader->stream->size) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: %zu bytes cannot hold %lld x %lld pixels: it was cut off",
                         reader->name, reader->stream->size, (long long)width, (long long)height);
    }
    alp_image_info info = {(uint32_t)width, (uint32_t)height, channels, ALP_COMPONENT_FLOAT};
    return alp_image_create(context, info, &reader->image);
}

/// Index of a channel of the file in the image, or −1.
static int channel_index(const char *const *channels, uint32_t count, const char *name)
{
    for (uint32_t k = 0; k < count; k++) {
        if (strcmp(channels[k], name) == 0) {
            return (int)k;
        }
    }
    return -1;
}

/// Aims a coded channel at floats of ours: where its first one is and how far apart in floats.
static void aim_channel(exr_coding_channel_info_t *coded, float *first, uint32_t pixel_stride,
                        uint32_t line_stride)
{
    coded->user_bytes_per_element = sizeof(float);
    coded->user_data_type = EXR_PIXEL_FLOAT;
    coded->user_pixel_stride = (int32_t)(pixel_stride * sizeof(float));
    coded->user_line_stride = (int32_t)(line_stride * sizeof(float));
    coded->decode_to_ptr = (uint8_t *)first;
}

/// Decodes into planes, not into the pixels, and channels that nobody wants into a last plane:
/// OpenEXRCore 3.1.5 swaps R and A where it interleaves four halves, and follows the null pointer
/// of an unwanted channel where it unpacks three.
static alp_result decode_planes(exr_reader *reader, const exr_chunk_info_t *chunk)
{
    exr_decode_pipeline_t *decode = &reader->decode;
    bool first = !reader->decoding;
    if (first) {
        TRY_EXR(reader, exr_decoding_initialize(reader->exr, 0, chunk, decode));
        reader->decoding = true;
    } else {
        TRY_EXR(reader, exr_decoding_update(reader->exr, 0, chunk, decode));
    }
    uint32_t wanted = reader->image->info.channels;
    size_t plane_size = (size_t)chunk->width * (size_t)chunk->height;
    for (int i = 0; i < decode->channel_count; i++) {
        exr_coding_channel_info_t *coded = &decode->channels[i];
        int k = channel_index(reader->channels, wanted, coded->channel_name);
        size_t plane = k < 0 ? wanted : (size_t)k;
        aim_channel(coded, reader->planes + plane * plane_size, 1, (uint32_t)chunk->width);
        if (coded->data_type == EXR_PIXEL_UINT) { // never a wanted one
            coded->user_data_type = EXR_PIXEL_UINT;
        }
    }
    if (first) {
        TRY_EXR(reader, exr_decoding_choose_default_routines(reader->exr, 0, decode));
    }
    TRY_EXR(reader, exr_decoding_run(reader->exr, 0, decode));
    return ALP_OK;
}

/// Decodes a chunk whose upper left pixel is (x, y) of the image.
static alp_result decode_chunk(exr_reader *reader, const exr_chunk_info_t *chunk, uint32_t x,
                               uint32_t y)
{
    alp_image *image = reader->image;
    uint32_t width = (uint32_t)chunk->width, height = (uint32_t)chunk->height;
    if (chunk->width < 1 || chunk->height < 1 || width > image->info.width - x ||
        height > image->info.height - y) {
        return alpi_fail(reader->stream->context, ALP_ERROR_INVALID_DATA,
                         "%s: chunk %d reaches out of the image", reader->name, chunk->idx);
    }
    if (reader->planes == NULL) { // the first chunk is the largest
        ALPI_TRY_NEW(reader->stream->context, reader->planes,
                     (size_t)width * height * (image->info.channels + 1));
    }
    ALP_TRY(decode_planes(reader, chunk));
    for (uint32_t k = 0; k < image->info.channels; k++) {
        const float *plane = reader->planes + (size_t)k * width * height;
        for (uint32_t row = 0; row < height; row++) {
            float *pixel = (float *)image->pixels +
                           ((size_t)(y + row) * image->info.width + x) * image->info.channels + k;
            for (uint32_t column = 0; column < width; column++) {
                pixel[(size_t)column * image->info.channels] = plane[(size_t)row * width + column];
            }
        }
    }
    return ALP_OK;
}

static alp_result decode_scanlines(exr_reader *reader)
{
    int32_t lines = 0;
    TRY_EXR(reader, exr_get_scanlines_per_chunk(reader->exr, 0, &lines));
    for (uint32_t y = 0; y < reader->image->info.height; y += (uint32_t)lines) {
        exr_chunk_info_t chunk;
        int line = reader->window.min.y + (int)y;
        TRY_EXR(reader, exr_read_scanline_chunk_info(reader->exr, 0, line, &chunk));
        ALP_TRY(decode_chunk(reader, &chunk, 0, y));
    }
    return ALP_OK;
}

/// Tiles of the full-size level; smaller levels are not looked at.
static alp_result decode_tiles(exr_reader *reader)
{
    int32_t tile_width = 0, tile_height = 0;
    TRY_EXR(reader, exr_get_tile_sizes(reader->exr, 0, 0, 0, &tile_width, &tile_height));
    if (tile_width < 1 || tile_height < 1) {
        return alpi_fail(reader->stream->context, ALP_ERROR_INVALID_DATA,
                         "%s: its tiles have no size", reader->name);
    }
    uint32_t width = reader->image->info.width, height = reader->image->info.height;
    for (uint64_t y = 0, row = 0; y < height; y += (uint64_t)tile_height, row++) {
        for (uint64_t x = 0, column = 0; x < width; x += (uint64_t)tile_width, column++) {
            exr_chunk_info_t chunk;
            TRY_EXR(reader,
                    exr_read_tile_chunk_info(reader->exr, 0, (int)column, (int)row, 0, 0, &chunk));
            ALP_TRY(decode_chunk(reader, &chunk, (uint32_t)x, (uint32_t)y));
        }
    }
    return ALP_OK;
}

/// Gives the colours of a file that states a scale their values back. Last of all, as the library
/// tells of an attribute that is not there as of a fault.
static void take_scale(const exr_reader *reader)
{
    float scale = 1.0f;
    if (exr_attr_get_float(reader->exr, 0, SCALE_NAME, &scale) != EXR_ERR_SUCCESS ||
        !(scale > 0.0f && scale < INFINITY)) {
        return;
    }
    const alp_image_info *info = &reader->image->info;
    const uint32_t colors = info->channels - (info->channels % 2 == 0 ? 1 : 0); // and alpha
    float *pixels = reader->image->pixels;
    for (size_t i = 0; i < (size_t)info->width * info->height; i++) {
        for (uint32_t k = 0; k < colors; k++) {
            pixels[i * info->channels + k] *= scale;
        }
    }
}

static alp_result read_part(exr_reader *reader)
{
    ALP_TRY(check_kind(reader));
    uint32_t channels = 0;
    ALP_TRY(choose_channels(reader, &channels));
    ALP_TRY(create_image(reader, channels));
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    TRY_EXR(reader, exr_get_storage(reader->exr, 0, &storage));
    ALP_TRY(storage == EXR_STORAGE_TILED ? decode_tiles(reader) : decode_scanlines(reader));
    take_scale(reader);
    return ALP_OK;
}

alp_result alpi_exr_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image)
{
    *image = NULL;
    exr_stream stream = {.context = context, .input = bytes, .size = size};
    exr_context_initializer_t options = initializer(&stream);
    options.read_fn = read_bytes;
    options.size_fn = query_size;
    exr_reader reader = {.stream = &stream, .name = name};
    exr_result_t code = exr_start_read(&reader.exr, name, &options);
    if (code != EXR_ERR_SUCCESS) {
        return fail_exr(&stream, name, code);
    }
    alp_result result = read_part(&reader);
    if (reader.decoding) {
        exr_decoding_destroy(reader.exr, &reader.decode);
    }
    exr_finish(&reader.exr);
    alpi_release(context, reader.planes);
    if (result == ALP_OK) {
        *image = reader.image;
    } else {
        alp_image_destroy(reader.image);
    }
    return result;
}

// --- writing -------------------------------------------------------------------------------------

/// What is written, and as what.
typedef struct exr_source {
    const alp_image *image;
    const char *const *channels; // [count]
    uint32_t count;
    const uint16_t *halves; // [height][width][count], or NULL: the floats of the image
    float scale;            // stated where it is not 1
} exr_source;

static exr_result_t write_header(exr_context_t exr, const exr_source *source)
{
    const alp_image *image = source->image;
    const exr_pixel_type_t type = source->halves != NULL ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    int part = 0;
    exr_result_t code = exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS) {
        code =
            exr_initialize_required_attr_simple(exr, part, (int32_t)image->info.width,
                                                (int32_t)image->info.height, EXR_COMPRESSION_ZIP);
    }
    for (uint32_t k = 0; code == EXR_ERR_SUCCESS && k < source->count; k++) {
        code = exr_add_channel(exr, part, source->channels[k], type, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    if (code == EXR_ERR_SUCCESS && source->scale != 1.0f) {
        code = exr_attr_set_float(exr, part, SCALE_NAME, source->scale);
    }
    return code == EXR_ERR_SUCCESS ? exr_write_header(exr) : code;
}

/// Points every channel of a chunk at its first value in line y.
static void aim_encoder(exr_encode_pipeline_t *encode, const exr_source *source, uint32_t y)
{
    const uint32_t count = source->count, width = source->image->info.width;
    const size_t line = (size_t)y * width * count;
    for (int i = 0; i < encode->channel_count; i++) {
        exr_coding_channel_info_t *coded = &encode->channels[i];
        const int k = channel_index(source->channels, count, coded->channel_name);
        if (source->halves == NULL) {
            aim_channel(coded, (float *)source->image->pixels + line + k, count, width * count);
            continue;
        }
        coded->user_bytes_per_element = sizeof(uint16_t);
        coded->user_data_type = EXR_PIXEL_HALF;
        coded->user_pixel_stride = (int32_t)(count * sizeof(uint16_t));
        coded->user_line_stride = (int32_t)(width * count * sizeof(uint16_t));
        coded->encode_from_ptr = (const uint8_t *)(source->halves + line + k);
    }
}

static exr_result_t write_chunks(exr_context_t exr, const exr_source *source,
                                 exr_encode_pipeline_t *encode)
{
    const alp_image *image = source->image;
    exr_stream *stream = stream_of(exr);
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(exr, 0, &lines);
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && y < image->info.height; y += (uint32_t)lines) {
        if (alpi_tick(image->context, "write", y, image->info.height) != ALP_OK) {
            stream->cancelled = true;
            return EXR_ERR_UNKNOWN;
        }
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(exr, 0, (int)y, &chunk);
        if (code == EXR_ERR_SUCCESS) {
            code = y == 0 ? exr_encoding_initialize(exr, 0, &chunk, encode)
                          : exr_encoding_update(exr, 0, &chunk, encode);
        }
        if (code == EXR_ERR_SUCCESS) {
            aim_encoder(encode, source, y);
        }
        if (code == EXR_ERR_SUCCESS && y == 0) {
            code = exr_encoding_choose_default_routines(exr, 0, encode);
        }
        if (code == EXR_ERR_SUCCESS) {
            code = exr_encoding_run(exr, 0, encode);
        }
    }
    return code;
}

static alp_result encode_source(const exr_source *source, uint8_t **bytes, size_t *size)
{
    alp_context *context = source->image->context;
    exr_stream stream = {.context = context};
    exr_context_initializer_t options = initializer(&stream);
    options.write_fn = write_bytes;
    exr_context_t exr = NULL;
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_start_write(&exr, "image.exr", EXR_WRITE_FILE_DIRECTLY, &options);
    if (code == EXR_ERR_SUCCESS) {
        code = write_header(exr, source);
        code = code == EXR_ERR_SUCCESS ? write_chunks(exr, source, &encode) : code;
        exr_encoding_destroy(exr, &encode);
        exr_result_t finished = exr_finish(&exr); // writes the table of chunks
        code = code == EXR_ERR_SUCCESS ? finished : code;
    }
    if (code != EXR_ERR_SUCCESS) {
        alpi_release(context, stream.output);
        if (stream.cancelled) {
            return ALP_ERROR_CANCELLED; // the message says so
        }
        if (code == EXR_ERR_OUT_OF_MEMORY || stream.out_of_memory) {
            return alpi_fail(context, ALP_ERROR_OUT_OF_MEMORY,
                             "out of memory: writing an EXR image of %u x %u pixels",
                             source->image->info.width, source->image->info.height);
        }
        return alpi_fail(context, ALP_ERROR_IO, "writing an EXR image: %s",
                         stream.message[0] ? stream.message : exr_get_default_error_message(code));
    }
    *bytes = alpi_reallocate(context, stream.output, stream.size, 1); // held till all is written
    if (*bytes == NULL) {
        alpi_release(context, stream.output);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *size = stream.size;
    return ALP_OK;
}

static alp_result check_floats(const alp_image *image, uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    return image->info.component == ALP_COMPONENT_FLOAT
               ? ALP_OK
               : alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                           "EXR holds float images; save an 8-bit one as PNG");
}

alp_result alpi_exr_encode(const alp_image *image, uint8_t **bytes, size_t *size)
{
    ALP_TRY(check_floats(image, bytes, size));
    const uint32_t count = image->info.channels;
    const exr_source source = {image, count < 3 ? GREY : COLOR, count, NULL, 1.0f};
    return encode_source(&source, bytes, size);
}

alp_result alpi_exr_encode_half(const alp_image *image, float scale, bool alpha, uint8_t **bytes,
                                size_t *size)
{
    ALP_TRY(check_floats(image, bytes, size));
    const uint32_t channels = image->info.channels;
    const uint32_t count = alpha ? channels : channels < 3 ? 1 : 3;
    const size_t pixels = (size_t)image->info.width * image->info.height;
    uint16_t *halves = ALPI_NEW(image->context, uint16_t, count * pixels);
    if (halves == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const float *floats = image->pixels;
    for (size_t i = 0; i < count * pixels; i++) {
        halves[i] = alpi_half_from_float(floats[i / count * channels + i % count]);
    }
    const exr_source source = {image, count < 3 ? GREY : COLOR, count, halves, scale};
    const alp_result result = encode_source(&source, bytes, size);
    alpi_release(image->context, halves);
    return result;
}
