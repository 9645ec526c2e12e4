// Which blocks of a tile, and which of its pixels, the hits of a chunk reach. Boxes around the
// blocks decide most of it; pixels are asked where they do not.
#define PIXELS_MAX     1024 // of a tile, whole blocks
#define MASK_WORDS_MAX 32

layout(binding = 10) uniform texture2D depths;

shared float pixel_z[PIXELS_MAX]; // block by block, each row by row; negative: sky
shared uint nearest_bits[HDRP_CULL_BLOCK_COUNT]; // of depths in each block: those of floats that
shared uint farthest_bits[HDRP_CULL_BLOCK_COUNT]; // are not negative rise with them
shared hdrp_cull_box block_boxes[HDRP_CULL_BLOCK_COUNT];
shared hdrp_v3 corners[4];        // where four of the pixels are
shared uint undecided[GROUP_MAX]; // blocks of each hit whose pixels are to be asked
shared uint mask_words[GROUP_MAX * MASK_WORDS_MAX];
shared uint is_read;

uvec2 tile_begin;

uint pixels_of_block()
{
    return frame.grid.cells.z * frame.grid.cells.w;
}

// A quotient of whole numbers of up to 1024, which devices without integer division make faster so.
uint quotient(uint a, uint b)
{
    return uint((float(a) + 0.5) * (1.0 / float(b)));
}

// Where the pixel at a place of pixel_z is in its tile.
uvec2 pixel_at(uint place)
{
    uint block = quotient(place, pixels_of_block());
    uint rest = place - block * pixels_of_block();
    uint row = quotient(rest, frame.grid.cells.z);
    return uvec2((block & 3u) * frame.grid.cells.z + rest - row * frame.grid.cells.z,
                 (block >> 2) * frame.grid.cells.w + row);
}

hdrp_v3 place_of(uvec2 pixel, float z)
{
    return hdrp_cull_pixel_in_view(frame.camera, frame.pixel.xy,
                                   float(tile_begin.x) + 0.5 + float(pixel.x),
                                   float(frame.picture.y) - float(tile_begin.y) - 0.5 -
                                       float(pixel.y),
                                   z);
}

void begin_pixels(uvec2 begin)
{
    tile_begin = begin;
    if (gl_LocalInvocationIndex == 0u) {
        is_read = 0u;
    }
    wait_for_group();
}

// Some pixels of a block, each step-th from a first one on.
void read_block(uint block, uint first, uint step)
{
    uvec2 size = frame.grid.cells.zw;
    uvec2 begin = uvec2(block & 3u, block >> 2) * size;
    // Blocks may be wider than the tile, and reach beyond the picture.
    uvec2 end = min(frame.grid.tiles.xy, frame.picture.xy - tile_begin);
    float nearest = HDRP_FLT_MAX;
    float farthest = -1.0;
    uint k = first;
    do {
        uint row = quotient(k, size.x);
        uvec2 at = begin + uvec2(k - row * size.x, row);
        float z = -1.0;
        if (all(lessThan(at, end))) {
            float texel = texelFetch(depths, ivec2(tile_begin + at), 0).x;
            z = frame.picture.w != 0u ? hdrp_view_depth(frame.device, texel) : texel;
            z = hdrp_cull_opaque_depth(z, frame.pixel.z, frame.pixel.w);
        }
        if (k < pixels_of_block() && block < HDRP_CULL_BLOCK_COUNT) {
            pixel_z[block * pixels_of_block() + k] = z;
            nearest = z >= 0.0 && z < nearest ? z : nearest;
            farthest = z > farthest ? z : farthest;
        }
        k += step;
    } while (k < pixels_of_block());
    if (farthest >= 0.0) { // an opaque depth is above 0, so that 0 is left for sky
        atomicMin(nearest_bits[block], hdrp_bits_from_f32(nearest));
        atomicMax(farthest_bits[block], hdrp_bits_from_f32(farthest));
    }
}

hdrp_cull_box box_of(uint block)
{
    hdrp_v2 size = hdrp_v2(frame.pixel.x * float(frame.grid.cells.z),
                           frame.pixel.y * float(frame.grid.cells.w));
    float farthest = farthest_bits[block] == 0u ? -1.0 : hdrp_f32_from_bits(farthest_bits[block]);
    return hdrp_cull_block_box(
        window.tile.window, size, block,
        hdrp_cull_interval(hdrp_f32_from_bits(nearest_bits[block]), farthest),
        frame.camera.forward_orthographic.w);
}

// In the middle of one of the blocks at the corners.
hdrp_v3 corner(uint k)
{
    uint block = (k >> 1) * 12u + (k & 1u) * 3u;
    uint place = block * pixels_of_block() + (frame.grid.cells.w / 2u) * frame.grid.cells.z +
                 frame.grid.cells.z / 2u;
    return place_of(pixel_at(place), pixel_z[place]);
}

void read_pixels()
{
    uint thread = gl_LocalInvocationIndex;
    uint of_block = max(GROUP / HDRP_CULL_BLOCK_COUNT, 1u); // threads
    for (uint b = thread; b < HDRP_CULL_BLOCK_COUNT; b += GROUP) {
        nearest_bits[b] = hdrp_bits_from_f32(HDRP_FLT_MAX);
        farthest_bits[b] = 0u;
    }
    wait_for_group();
    uint block = thread / of_block;
    do {
        read_block(block, thread % of_block, of_block);
        block += GROUP / of_block;
    } while (block < HDRP_CULL_BLOCK_COUNT);
    wait_for_group();
    uint b = thread;
    do {
        if (b < HDRP_CULL_BLOCK_COUNT) {
            block_boxes[b] = box_of(b);
        }
        if (b < 4u) {
            corners[b] = corner(b);
        }
        b += GROUP;
    } while (b < HDRP_CULL_BLOCK_COUNT);
    wait_for_group();
}

// Whether a ball contains one of four pixels, which most do that reach any.
bool contains_a_corner(vec4 ball)
{
    float nearest2 = HDRP_FLT_MAX;
    for (uint k = 0u; k < 4u; ++k) {
        if (corners[k].z >= 0.0) {
            nearest2 = hdrp_min(hdrp_cull_distance_sq(ball, corners[k]), nearest2);
        }
    }
    return nearest2 <= ball.w * ball.w;
}

void fill_mask(uint hit, uint word)
{
    for (uint k = 0u; k < hdrp_cull_mask_words(frame.grid); ++k) {
        mask_words[hit * MASK_WORDS_MAX + k] = word;
    }
}

// All pixels of a block, those of sky too.
void note_block(uint hit, uint block)
{
    uint begin = block * pixels_of_block();
    uint last = begin + pixels_of_block() - 1u;
    for (uint k = begin >> 5; k <= last >> 5; ++k) {
        uint low = k == begin >> 5 ? begin & 31u : 0u;
        uint high = k == last >> 5 ? last & 31u : 31u;
        mask_words[hit * MASK_WORDS_MAX + k] |= (0xffffffffu >> (31u - high + low)) << low;
    }
}

// What boxes say of a hit: the blocks that it reaches for sure, and those that are undecided.
void ask_boxes(uint hit)
{
    Seen s = seen_shapes[hits[hit]];
    bool ball = is_ball(s);
    bool all = (frame.picture.z & FLAG_BLOCKS) != 0u;
    bool has_masks = (frame.picture.z & FLAG_MASKS) != 0u;
    uint reached = 0u;
    undecided[hit] = 0u;
    if (ball && !all && contains_a_corner(s.ball)) {
        return; // blocks is 0xffff: one pixel decides for all of them
    }
    if (has_masks) {
        fill_mask(hit, 0u);
    }
    [[dont_unroll]] for (uint row = 0u; row < HDRP_CULL_BLOCK_COUNT; row += 4u) {
        for (uint b = row; b < row + 4u; ++b) {
            reached |= hdrp_cull_box_in_ball(block_boxes[b], s.ball) << b;
        }
    }
    uint inside = ball ? reached >> 16 : 0u; // inside its ball is inside a shape only if it is one
    for (uint b = 0u; has_masks && b < HDRP_CULL_BLOCK_COUNT; ++b) {
        if ((inside >> b & 1u) != 0u) {
            note_block(hit, b);
        }
    }
    undecided[hit] = all || inside == 0u ? reached & 0xffffu & ~inside : 0u;
    blocks[hit] = inside;
}

void ask_pixel(uint hit, hdrp_cull_shape shape, uint block, uint k)
{
    uint p = block * pixels_of_block() + k;
    if (k < pixels_of_block() && pixel_z[p] >= 0.0 &&
        hdrp_cull_shape_contains(shape, place_of(pixel_at(p), pixel_z[p])) > 0.0) {
        atomicOr(blocks[hit], 1u << block);
        if ((frame.picture.z & FLAG_MASKS) != 0u) {
            atomicOr(mask_words[hit * MASK_WORDS_MAX + (p >> 5)], 1u << (p & 31u));
        }
    }
}

// A thread asks its pixels about a hit, of which some block is undecided. As many blocks at once as
// there are threads for.
void ask_own_pixels(uint hit)
{
    hdrp_cull_shape shape = shapes[hits[hit]];
    bool one_is_enough = (frame.picture.z & (FLAG_BLOCKS | FLAG_MASKS)) == 0u;
    uint of_block = pixels_of_block();
    uint at_once = clamp(GROUP / of_block, 1u, HDRP_CULL_BLOCK_COUNT);
    uint step = at_once > 1u ? of_block : GROUP;
    uint own_block = min(gl_LocalInvocationIndex / of_block, at_once); // the last threads: none
    uint own_pixel = at_once > 1u ? gl_LocalInvocationIndex % of_block : gl_LocalInvocationIndex;
    own_block = at_once > 1u ? own_block : 0u;
    uint rest = undecided[hit];
    do {
        uint first = uint(findLSB(rest)) / at_once * at_once;
        uint block = first + own_block;
        if (own_block < at_once && (rest >> block & 1u) != 0u) {
            uint k = own_pixel;
            do { // few turns: see group.glsl
                ask_pixel(hit, shape, block, k);
                ask_pixel(hit, shape, block, k + step);
                k += 2u * step;
            } while (k < of_block);
        }
        rest &= ~(((1u << at_once) - 1u) << first);
        if (one_is_enough) {
            wait_for_group();
            rest = blocks[hit] != 0u ? 0u : rest;
            wait_for_group();
        }
    } while (rest != 0u);
}

// The blocks of the hits of a chunk.
void ask_pixels(uint n)
{
    uint thread = gl_LocalInvocationIndex;
    bool all = (frame.picture.z & FLAG_BLOCKS) != 0u;
    bool around = false;
    if (thread < n) {
        Seen s = seen_shapes[hits[thread]];
        hdrp_cull_box box =
            hdrp_cull_window_box(window.tile.window, hdrp_cull_interval(info.x, info.y),
                                 frame.camera.forward_orthographic.w);
        around = is_ball(s) && hdrp_cull_box_in_ball(box, s.ball) >> 16 != 0u;
        undecided[thread] = 0u;
        if (around && (frame.picture.z & FLAG_MASKS) != 0u) {
            fill_mask(thread, 0xffffffffu);
        }
    }
    uint open; // hits that do not contain the whole of what the tile shows
    place_among(thread < n && !around, open);
    if (open == 0u) {
        return;
    }
    if (is_read == 0u) { // for all threads: what they wait for below is between
        read_pixels();
    }
    wait_for_group();
    if (thread == 0u) {
        is_read = 1u;
    }
    if (thread < n && !around) {
        ask_boxes(thread);
    }
    wait_for_group();
    uint h = 0u;
    do {
        while (h < n && undecided[h] == 0u) { // on its own: what is below takes its time even so
            ++h;
        }
        if (h < n) {
            ask_own_pixels(h);
        }
    } while (++h < n);
    wait_for_group();
    if (!all && thread < n && blocks[thread] != 0u) {
        blocks[thread] = 0xffffu;
    }
    wait_for_group();
}

void write_mask(uint entry, uint hit)
{
    if ((frame.picture.z & FLAG_MASKS) == 0u) {
        return;
    }
    uint words = hdrp_cull_mask_words(frame.grid);
    for (uint k = 0u; k < words; ++k) {
        masks[entry * words + k] = mask_words[hit * MASK_WORDS_MAX + k];
    }
}
