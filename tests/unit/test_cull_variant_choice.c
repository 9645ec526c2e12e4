/* test_cull_variant_choice.c - the choice of variants: costs, reports, optima and bounds.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define HDRP_CULL_IMPLEMENTATION
#include "hdrp_cull_variant.h"

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static double test_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static uint32_t test_below(uint64_t* state, uint32_t n)
{
    return (uint32_t)(test_random(state) * n);
}

/* A GPU on which each feature adds instructions, waiting and registers, with steps or without. */
static hdrp_cull_cost_model make_model(uint64_t* random, bool has_steps)
{
    hdrp_cull_cost_model m = {0};
    m.alu = 5.0 + 20.0 * test_random(random);
    m.register_count = 256.0;
    m.waves_max = 10.0;
    m.registers = 24.0;
    for (int b = 0; b < 32; ++b) {
        double c = 1.0 + 40.0 * test_random(random) * test_random(random);
        m.feature_alu[b] = has_steps ? 0.5 * c : c;
        m.feature_latency[b] = has_steps ? 0.5 * c : 0.0;
        m.feature_registers[b] = 10.0 * test_random(random);
        m.feature_peak[b] = 20.0 * test_random(random);
    }
    return m;
}

enum histogram_kind { RANDOM, VARIATIONS };

/* Distinct sets: each bit by chance, or a few materials with some bits changed, with weights that
 * are even or fall off as 1/i (Zipf). */
static uint32_t make_sets(uint64_t* random, hdrp_cull_feature_count* sets, uint32_t wanted,
                          uint32_t bits, enum histogram_kind kind, bool is_skewed)
{
    uint32_t base[6] = {0u}, count = 0u;
    double density = 0.1 + 0.4 * test_random(random);
    for (uint32_t i = 0u; i < 6u * bits; ++i) {
        base[i / bits] |= test_random(random) < 0.4 ? 1u << i % bits : 0u;
    }
    for (uint32_t i = 0u; i < wanted; ++i) {
        uint32_t f = kind == VARIATIONS ? base[test_below(random, 6u)] : 0u, k = 0u;
        for (uint32_t b = 0u; kind == RANDOM && b < bits; ++b) {
            f |= test_random(random) < density ? 1u << b : 0u;
        }
        for (uint32_t q = 0u; kind == VARIATIONS && q < 3u; ++q) {
            f ^= test_random(random) < 0.7 ? 1u << test_below(random, bits) : 0u;
        }
        while (k < count && sets[k].features != f) {
            ++k;
        }
        if (k == count) {
            sets[count].features = f;
            sets[count++].weight = is_skewed ? 1u + 20000u / (1u + i) : test_below(random, 1000u);
        }
    }
    return count;
}

static hdrp_result choose(const hdrp_cull_choice_desc* desc, hdrp_cull_choice* choice)
{
    size_t bytes = hdrp_cull_choose_memory_size(desc);
    unsigned char* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes + HDRP_MEMORY_ALIGNMENT);
    hdrp_result result;
    assert_true(bytes > 0u && memory);
    memset(memory, 0xa5, bytes + HDRP_MEMORY_ALIGNMENT);
    memset(choice, 0x5a, sizeof *choice);
    result = hdrp_cull_choose_variants(desc, memory, bytes, choice);
    for (int i = 0; i < HDRP_MEMORY_ALIGNMENT; ++i) {
        assert_int_equal(memory[bytes + (size_t)i], 0xa5);
    }
    free(memory);
    return result;
}

/* Coverage, order, and the total, computed again. */
static void check_choice(const hdrp_cull_choice_desc* desc, const hdrp_cull_choice* choice)
{
    double total = 0.0;
    assert_in_range(choice->variant_count, 1, desc->variant_limit);
    for (uint32_t r = 0u; r < choice->variant_count; ++r) {
        assert_true(choice->costs[r] == desc->cost(choice->masks[r], desc->user));
        assert_true(r == 0u || choice->costs[r - 1u] <= choice->costs[r]);
    }
    for (uint32_t i = 0u; i < desc->set_count; ++i) {
        double least = HUGE_VAL;
        for (uint32_t r = 0u; r < choice->variant_count; ++r) {
            if ((choice->masks[r] | desc->sets[i].features) == choice->masks[r] &&
                choice->costs[r] < least) {
                least = choice->costs[r];
            }
        }
        assert_true(least < HUGE_VAL);
        total += least * (double)desc->sets[i].weight;
    }
    assert_true(fabs(total - choice->total_cost) <= 1e-12 * total);
    assert_true(choice->lower_bound <= choice->total_cost);
}

/* The best total of all choices of at most K masks out of all that the bits allow, by recursion
 * over masks: each is taken or not. */
typedef struct brute_force {
    const hdrp_cull_choice_desc* desc;
    uint32_t mask_count;
    double costs[64];
    double best;
} brute_force;

static void brute_force_from(brute_force* b, uint32_t mask, uint32_t left, const double* so_far)
{
    double total = 0.0;
    for (uint32_t i = 0u; i < b->desc->set_count; ++i) {
        total += so_far[i] * (double)b->desc->sets[i].weight;
    }
    b->best = total < b->best ? total : b->best;
    for (; left > 0u && mask < b->mask_count; ++mask) {
        double next[16];
        bool helps = false;
        for (uint32_t i = 0u; i < b->desc->set_count; ++i) {
            bool covers = (b->desc->sets[i].features | mask) == mask;
            next[i] = covers && b->costs[mask] < so_far[i] ? b->costs[mask] : so_far[i];
            helps = helps || next[i] < so_far[i];
        }
        if (helps) {
            brute_force_from(b, mask + 1u, left - 1u, next);
        }
    }
}

static double brute_force_cost(const hdrp_cull_choice_desc* desc, uint32_t bits)
{
    brute_force b = {desc, 1u << bits, {0.0}, HUGE_VAL};
    double none[16];
    for (uint32_t m = 0u; m < b.mask_count; ++m) {
        b.costs[m] = desc->cost(m, desc->user);
    }
    for (int i = 0; i < 16; ++i) {
        none[i] = 1e30; /* finite, so that sets of weight 0 must be covered too */
    }
    for (uint32_t i = 0u; i < desc->set_count; ++i) {
        assert_true(desc->sets[i].weight > 0u);
    }
    brute_force_from(&b, 0u, desc->variant_limit, none);
    return b.best;
}

static void small_choices_cost_as_little_as_the_best_of_all(void** state)
{
    (void)state;
    uint64_t random = 11u;
    for (int t = 0; t < 300; ++t) {
        uint32_t bits = 3u + test_below(&random, 3u), limit = 1u + test_below(&random, 4u);
        hdrp_cull_cost_model model = make_model(&random, t % 2 == 0);
        hdrp_cull_feature_count sets[16];
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice choice;
        double best;
        desc.sets = sets;
        desc.set_count = make_sets(&random, sets, 2u + test_below(&random, 12u), bits,
                                   t % 3 == 0 ? VARIATIONS : RANDOM, t % 5 < 3);
        for (uint32_t i = 0u; i < desc.set_count; ++i) {
            sets[i].weight += sets[i].weight == 0u;
        }
        desc.variant_limit = limit;
        desc.cost = hdrp_cull_model_cost;
        desc.user = &model;
        assert_int_equal(choose(&desc, &choice), HDRP_OK);
        check_choice(&desc, &choice);
        best = brute_force_cost(&desc, bits);
        assert_true(choice.is_optimal == 1u && choice.is_monotone == 1u);
        assert_true(fabs(choice.total_cost - best) <= 1e-9 * best);
        assert_true(choice.lower_bound <= best && choice.lower_bound >= 0.99999 * best);
    }
}

/* Dear where few features are, so that unions are cheaper than what they are made of. */
static double falling_cost(hdrp_u32 features, void* user)
{
    const double* table = (const double*)user;
    return table[features & 31u];
}

static double best_of_unions(const hdrp_cull_choice_desc* desc)
{
    double saved[32], best;
    double* table = (double*)desc->user;
    memcpy(saved, table, sizeof saved);
    for (uint32_t m = 0u; m < 32u; ++m) {
        uint32_t u = 0u;
        for (uint32_t i = 0u; i < desc->set_count; ++i) {
            u |= (desc->sets[i].features | m) == m ? desc->sets[i].features : 0u;
        }
        table[m] = u == m ? saved[m] : 1e9; /* no union of sets */
    }
    best = brute_force_cost(desc, 5u);
    memcpy(table, saved, sizeof saved);
    return best;
}

static void a_cost_that_is_not_monotone_gets_the_best_of_all_unions(void** state)
{
    (void)state;
    uint64_t random = 5u;
    uint32_t noticed = 0u;
    for (int t = 0; t < 100; ++t) {
        double table[32];
        hdrp_cull_feature_count sets[16];
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice choice;
        double best;
        for (int m = 0; m < 32; ++m) {
            table[m] = 1.0 + 9.0 * test_random(&random);
        }
        desc.sets = sets;
        desc.set_count = make_sets(&random, sets, 9u, 5u, RANDOM, true);
        desc.variant_limit = 1u + test_below(&random, 4u);
        desc.cost = falling_cost;
        desc.user = table;
        assert_int_equal(choose(&desc, &choice), HDRP_OK);
        check_choice(&desc, &choice);
        best = best_of_unions(&desc);
        assert_true(fabs(choice.total_cost - best) <= 1e-9 * best);
        assert_int_equal(choice.is_optimal, 1);
        noticed += choice.is_monotone == 0u;
    }
    assert_true(noticed > 50u);
}

static void a_set_that_costs_more_than_its_union_with_others_is_noticed(void** state)
{
    (void)state;
    const hdrp_cull_feature_count sets[3] = {{10u, 1u}, {10u, 2u}, {10u, 4u}};
    double table[32] = {0.0, 2.0, 2.0, 3.0, 2.0, 3.0, 3.0, 6.0};
    hdrp_cull_choice_desc desc = {0};
    hdrp_cull_choice choice;
    desc.sets = sets;
    desc.set_count = 3u;
    desc.variant_limit = 2u;
    desc.cost = falling_cost;
    desc.user = table;
    for (int t = 0; t < 3; ++t) {
        table[1] = t == 1 ? 4.0 : 2.0; /* more than with the second set, less than with all */
        table[3] = t == 2 ? 7.0 : 3.0; /* a union of two costs more than all */
        assert_int_equal(choose(&desc, &choice), HDRP_OK);
        assert_int_equal(choice.is_monotone, t == 0);
        assert_true(choice.total_cost == 80.0 && choice.is_optimal == 1u);
    }
}

/* Histograms whose best choices are hard to find: an integer program, a variable for each union and
 * for each union that covers a set, was solved to optimality with HiGHS 1.2 (Huangfu and Hall
 * 2018), without a gap. */
static hdrp_cull_choice_desc make_hard(int t, hdrp_cull_feature_count* sets,
                                       hdrp_cull_cost_model* model)
{
    uint64_t random = 100u + (uint64_t)t;
    hdrp_cull_choice_desc desc = {0};
    *model = make_model(&random, true);
    desc.sets = sets;
    desc.set_count = make_sets(&random, sets, 40u, 12u, t % 2 == 0 ? RANDOM : VARIATIONS, true);
    desc.variant_limit = 4u + (uint32_t)t % 7u;
    desc.cost = hdrp_cull_model_cost;
    desc.user = model;
    return desc;
}

static void hard_choices_are_those_of_an_integer_program(void** state)
{
    (void)state;
    const struct {
        int t;
        double total;
    } known[] = {{6, 10473508.535},  {11, 13237664.687}, {15, 11430216.890}, {27, 12898541.991},
                 {38, 24162436.128}, {21, 17557123.733}, {18, 5426779.232},  {10, 11743278.966},
                 {26, 6193054.908},  {20, 6073809.603}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; ++k) {
        hdrp_cull_feature_count sets[40];
        hdrp_cull_cost_model model;
        hdrp_cull_choice_desc desc = make_hard(known[k].t, sets, &model);
        hdrp_cull_choice choice;
        for (uint32_t limit = 1u; limit <= 4096u; limit += 4095u) { /* walked, enumerated */
            desc.union_limit = limit;
            assert_int_equal(choose(&desc, &choice), HDRP_OK);
            check_choice(&desc, &choice);
            assert_int_equal(choice.is_optimal, 1);
            assert_true(fabs(choice.total_cost - known[k].total) <= 0.002);
            assert_true(choice.lower_bound >= known[k].total * (1.0 - 1e-6));
        }
    }
}

/* Sizes of games: up to 64 sets. */
static void usual_histograms_are_solved_and_proven(void** state)
{
    (void)state;
    uint64_t random = 1u;
    static hdrp_cull_feature_count sets[64];
    for (int t = 0; t < 40; ++t) {
        hdrp_cull_cost_model model = make_model(&random, t % 2 == 0);
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice choice;
        desc.sets = sets;
        desc.set_count =
            make_sets(&random, sets, 64u, 10u + test_below(&random, 8u), VARIATIONS, t % 4 < 2);
        desc.variant_limit = t % 4 == 0 ? 1u + test_below(&random, 16u) : 8u;
        desc.cost = hdrp_cull_model_cost;
        desc.user = &model;
        assert_int_equal(choose(&desc, &choice), HDRP_OK);
        check_choice(&desc, &choice);
        assert_int_equal(choice.is_optimal, 1);
        assert_true(choice.lower_bound >= (1.0 - 1e-6) * choice.total_cost);
    }
}

/* Hundreds of sets, more unions than there is room for. */
static void large_histograms_end_within_two_percent_of_their_bound(void** state)
{
    (void)state;
    uint64_t random = 2u;
    static hdrp_cull_feature_count sets[400];
    for (int t = 0; t < 8; ++t) {
        hdrp_cull_cost_model model = make_model(&random, t % 2 == 0);
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice choice;
        desc.sets = sets;
        desc.set_count = make_sets(&random, sets, 150u + 50u * (uint32_t)(t % 6), 12u + (uint32_t)t,
                                   VARIATIONS, t % 4 < 2);
        desc.variant_limit = 4u + test_below(&random, 9u);
        desc.cost = hdrp_cull_model_cost;
        desc.user = &model;
        desc.effort = 300u;
        assert_int_equal(choose(&desc, &choice), HDRP_OK);
        check_choice(&desc, &choice);
        assert_int_equal(choice.is_monotone, 1);
        assert_true(choice.lower_bound >= choice.total_cost / 1.02);
    }
}

/* The walk over features finds what enumerating all unions finds. */
static void it_does_not_matter_whether_there_is_room_for_all_unions(void** state)
{
    (void)state;
    uint64_t random = 31u;
    hdrp_cull_feature_count sets[45];
    uint32_t walked = 0u;
    for (int t = 0; t < 8; ++t) {
        hdrp_cull_cost_model model = make_model(&random, t % 2 == 0);
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice some, all;
        desc.sets = sets;
        desc.set_count = make_sets(&random, sets, 45u, 15u, RANDOM, t % 4 < 2);
        desc.variant_limit = 3u + (uint32_t)t % 4u;
        desc.cost = hdrp_cull_model_cost;
        desc.user = &model;
        assert_int_equal(choose(&desc, &some), HDRP_OK);
        desc.union_limit = 32767u;
        assert_int_equal(choose(&desc, &all), HDRP_OK);
        check_choice(&desc, &some);
        check_choice(&desc, &all);
        assert_true(all.is_optimal == 1u && some.is_optimal == 1u);
        assert_true(fabs(all.total_cost - some.total_cost) <= 1e-9 * all.total_cost);
        walked += all.candidate_count > 4096u && some.candidate_count < all.candidate_count;
    }
    assert_true(walked > 0u);
}

static void as_many_variants_as_sets_cost_what_the_sets_cost(void** state)
{
    (void)state;
    uint64_t random = 21u;
    hdrp_cull_feature_count sets[30];
    hdrp_cull_cost_model model = make_model(&random, true);
    hdrp_cull_choice_desc desc = {0};
    hdrp_cull_choice choice;
    double own = 0.0;
    desc.sets = sets;
    desc.set_count = make_sets(&random, sets, 30u, 12u, RANDOM, false);
    desc.variant_limit = HDRP_CULL_VARIANT_MAX;
    desc.cost = hdrp_cull_model_cost;
    desc.user = &model;
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    for (uint32_t i = 0u; i < desc.set_count; ++i) {
        own += (double)sets[i].weight * hdrp_cull_model_cost(sets[i].features, &model);
    }
    assert_true(fabs(choice.total_cost - own) <= 1e-12 * own && choice.is_optimal == 1u);
    desc.variant_limit = 1u;
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    assert_int_equal(choice.variant_count, 1);
    assert_int_equal(choice.masks[0], hdrp_cull_all_features(sets, desc.set_count));
    assert_int_equal(choice.is_optimal, 1);
}

static double bits_cost(hdrp_u32 features, void* user)
{
    double c = 1.0;
    (void)user;
    for (; features != 0u; features >>= 1) {
        c += features & 1u;
    }
    return c;
}

/* Weight 0 is covered; one set; all sets empty; costs of nothing and of enormous size. */
static void extreme_histograms_have_a_choice(void** state)
{
    (void)state;
    hdrp_cull_feature_count sets[4] = {{10u, 3u}, {0u, 12u}, {5u, 1u}, {4294967281u, 0u}};
    double zero[32] = {0.0}, huge[32];
    hdrp_cull_choice_desc desc = {0};
    hdrp_cull_choice choice;
    desc.sets = sets;
    desc.set_count = 4u;
    desc.variant_limit = 2u;
    desc.cost = bits_cost;
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    check_choice(&desc, &choice);
    /* The large weight of the empty set wants a variant of its own, so the other has all. */
    assert_int_equal(choice.masks[0], 0);
    assert_int_equal(choice.masks[1], 15);
    desc.set_count = 1u;
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    assert_int_equal(choice.masks[0], 3);
    assert_true(choice.variant_count == 1u && choice.total_cost == 30.0);
    desc.set_count = 3u;
    desc.cost = falling_cost;
    desc.user = zero;
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    check_choice(&desc, &choice);
    assert_true(choice.total_cost == 0.0 && choice.is_optimal == 1u);
    for (uint32_t m = 0u; m < 32u; ++m) {
        huge[m] = 1e28 * bits_cost(m, NULL);
    }
    desc.user = huge;
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    check_choice(&desc, &choice);
    for (uint32_t m = 0u; m < 32u; ++m) {
        huge[m] *= 1e-48;
    }
    assert_int_equal(choose(&desc, &choice), HDRP_OK);
    check_choice(&desc, &choice);
    assert_true(choice.total_cost > 0.0 && choice.is_optimal == 1u);
}

static void the_order_of_sets_and_the_contents_of_memory_do_not_matter(void** state)
{
    (void)state;
    uint64_t random = 8u;
    hdrp_cull_feature_count sets[40];
    hdrp_cull_cost_model model = make_model(&random, false);
    hdrp_cull_choice_desc desc = {0};
    hdrp_cull_choice a, b;
    size_t bytes;
    void* memory;
    desc.sets = sets;
    desc.set_count = make_sets(&random, sets, 40u, 14u, VARIATIONS, true);
    desc.variant_limit = 6u;
    desc.cost = hdrp_cull_model_cost;
    desc.user = &model;
    assert_int_equal(choose(&desc, &a), HDRP_OK);
    bytes = hdrp_cull_choose_memory_size(&desc);
    memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_non_null(memory);
    memset(memory, 0, bytes);
    assert_int_equal(hdrp_cull_choose_variants(&desc, memory, bytes, &b), HDRP_OK);
    assert_memory_equal(&a, &b, sizeof a);
    free(memory);
    for (uint32_t i = 0u; i < desc.set_count / 2u; ++i) {
        hdrp_cull_feature_count swapped = sets[i];
        sets[i] = sets[desc.set_count - 1u - i];
        sets[desc.set_count - 1u - i] = swapped;
    }
    assert_int_equal(choose(&desc, &b), HDRP_OK);
    assert_true(fabs(a.total_cost - b.total_cost) <= 1e-9 * a.total_cost);
}

/* However little work is allowed, the choice is valid and the bound is one. */
static void little_effort_gives_a_valid_choice_and_a_valid_bound(void** state)
{
    (void)state;
    uint64_t random = 14u;
    static hdrp_cull_feature_count sets[80];
    for (int t = 0; t < 6; ++t) {
        hdrp_cull_cost_model model = make_model(&random, true);
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice quick, slow;
        desc.sets = sets;
        desc.set_count = make_sets(&random, sets, 70u, 14u, VARIATIONS, true);
        desc.variant_limit = 5u;
        desc.cost = hdrp_cull_model_cost;
        desc.user = &model;
        desc.effort = 1u;
        assert_int_equal(choose(&desc, &quick), HDRP_OK);
        check_choice(&desc, &quick);
        desc.effort = 0u;
        assert_int_equal(choose(&desc, &slow), HDRP_OK);
        check_choice(&desc, &slow);
        assert_int_equal(slow.is_optimal, 1);
        assert_true(quick.lower_bound <= slow.total_cost);
        assert_true(slow.total_cost <= quick.total_cost);
    }
}

static double bad_cost(hdrp_u32 features, void* user)
{
    return features == *(const uint32_t*)user ? HUGE_VAL : bits_cost(features, NULL);
}

static void what_cannot_be_chosen_from_is_refused(void** state)
{
    (void)state;
    hdrp_cull_feature_count sets[2] = {{1u, 1u}, {1u, 2u}};
    uint32_t bad_set = 3u;
    hdrp_cull_choice_desc good = {0}, bad;
    hdrp_cull_choice choice;
    good.sets = sets;
    good.set_count = 2u;
    good.variant_limit = 2u;
    good.cost = bad_cost;
    good.user = &bad_set;
    size_t bytes = hdrp_cull_choose_memory_size(&good);
    unsigned char* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes + HDRP_MEMORY_ALIGNMENT);
    assert_non_null(memory);
    assert_int_equal(bytes % HDRP_MEMORY_ALIGNMENT, 0);
    for (int i = 0; i < 7; ++i) {
        bad = good;
        bad.set_count = i == 0 ? 0u : i == 1 ? HDRP_CULL_SET_MAX + 1u : 2u;
        bad.variant_limit = i == 2 ? 0u : i == 3 ? HDRP_CULL_VARIANT_MAX + 1u : 2u;
        bad.candidate_capacity = i == 4 ? 1048577u : 0u;
        bad.effort = i == 5 ? 1000001u : 0u;
        bad.union_limit = i == 6 ? 32768u : 0u;
        assert_int_equal(hdrp_cull_choose_memory_size(&bad), 0);
        assert_int_equal(hdrp_cull_choose_variants(&bad, memory, bytes, &choice),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    assert_int_equal(hdrp_cull_choose_memory_size(NULL), 0);
    memset(&choice, 0x5a, sizeof choice);
    for (uint32_t f = 1u; f <= 3u; ++f) { /* the cost of a set, or of the union, is infinite */
        bad_set = f;
        assert_int_equal(hdrp_cull_choose_variants(&good, memory, bytes, &choice),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    bad_set = 4u;
    assert_int_equal(hdrp_cull_choose_variants(&good, memory, bytes - 1u, &choice),
                     HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_cull_choose_variants(&good, memory + 4, bytes, &choice),
                     HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_int_equal(hdrp_cull_choose_variants(&good, NULL, bytes, &choice),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_choose_variants(NULL, memory, bytes, &choice),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_choose_variants(&good, memory, bytes, NULL),
                     HDRP_ERROR_NULL_POINTER);
    sets[0].weight = 4294967296u;
    assert_int_equal(hdrp_cull_choose_variants(&good, memory, bytes, &choice),
                     HDRP_ERROR_TOO_LARGE);
    assert_int_equal(choice.variant_count, 0x5a5a5a5au);
    sets[0].weight = 4294967295u;
    assert_int_equal(hdrp_cull_choose_variants(&good, memory, bytes, &choice), HDRP_OK);
    free(memory);
}

static void a_cost_model_adds_features_and_counts_whole_waves(void** state)
{
    (void)state;
    hdrp_cull_cost_model m = {0};
    m.alu = 2.0;
    m.latency = 10.0;
    m.registers = 25.0;
    m.register_count = 256.0;
    m.waves_max = 10.0;
    m.feature_alu[0] = 3.0;
    m.feature_latency[31] = 5.0;
    m.feature_registers[1] = 1.0;
    m.feature_peak[2] = 39.0;
    m.feature_peak[3] = 60.0;
    m.feature_registers[4] = 1000.0;
    /* 256 / 25 and 256 / 26 registers: 10 and 9 waves. */
    assert_true(hdrp_cull_model_cost(0u, &m) == 12.0);
    assert_true(hdrp_cull_model_cost(1u, &m) == 15.0);
    assert_true(hdrp_cull_model_cost(0x80000000u, &m) == 17.0);
    assert_true(fabs(hdrp_cull_model_cost(2u, &m) - (2.0 + 10.0 * 10.0 / 9.0)) < 1e-12);
    assert_true(hdrp_cull_model_cost(4u, &m) == 2.0 + 10.0 * 10.0 / 4.0);
    /* 25 + 60 registers, whether or not the smaller peak is there: 3 waves. */
    assert_true(fabs(hdrp_cull_model_cost(8u, &m) - (2.0 + 100.0 / 3.0)) < 1e-12);
    assert_true(hdrp_cull_model_cost(8u, &m) == hdrp_cull_model_cost(12u, &m));
    assert_true(hdrp_cull_model_cost(16u, &m) == 2.0 + 100.0); /* does not fit: one wave */
    assert_true(hdrp_cull_model_cost(1u, NULL) == 0.0);
}

static double no_cost(hdrp_u32 features, void* user)
{
    double no_number = (double)NAN;
    return features == *(const uint32_t*)user ? no_number : 1.0;
}

static void a_report_weighs_what_variants_serve_and_carry_in_vain(void** state)
{
    (void)state;
    const hdrp_cull_feature_count sets[4] = {{10u, 1u}, {20u, 2u}, {30u, 3u}, {7u, 16u}};
    const uint32_t masks[2] = {7u, 3u};
    const double costs[2] = {4.0, 3.0};
    hdrp_cull_variant_list list = {masks, NULL, 2u};
    hdrp_cull_variant_report reports[2];
    hdrp_cull_variant_total total = {0};
    assert_int_equal(hdrp_cull_report_variants(&list, sets, 4u, bits_cost, NULL, reports, &total),
                     HDRP_OK);
    assert_true(total.uncovered == 7u && total.cost == 60.0 * 4.0);
    assert_true(reports[0].weight == 60u && reports[1].weight == 0u);
    assert_true(reports[0].cost == 4.0 && reports[1].cost == 3.0);
    assert_true(reports[0].superfluous[0] == 20u && reports[0].superfluous[1] == 10u &&
                reports[0].superfluous[2] == 60u && reports[0].superfluous[3] == 0u);
    list.costs = costs; /* the second is cheaper */
    assert_int_equal(hdrp_cull_report_variants(&list, sets, 4u, bits_cost, NULL, reports, &total),
                     HDRP_OK);
    assert_true(total.cost == 60.0 * 3.0 && reports[1].superfluous[2] == 0u);
    assert_true(reports[0].weight == 0u && reports[1].weight == 60u);
    assert_int_equal(hdrp_cull_report_variants(&list, sets, 4u, bits_cost, NULL, NULL, &total),
                     HDRP_OK);
    assert_int_equal(hdrp_cull_report_variants(&list, sets, 4u, bits_cost, NULL, NULL, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_report_variants(NULL, sets, 4u, bits_cost, NULL, NULL, &total),
                     HDRP_ERROR_NULL_POINTER);
    list.count = 0u;
    assert_int_equal(hdrp_cull_report_variants(&list, sets, 4u, bits_cost, NULL, NULL, &total),
                     HDRP_ERROR_BAD_ARGUMENT);
    list.count = 2u;
    uint32_t bad_set = 3u;
    assert_int_equal(hdrp_cull_report_variants(&list, sets, 4u, no_cost, &bad_set, NULL, &total),
                     HDRP_ERROR_BAD_ARGUMENT);
}

/* Variants by hand in the order of complexity, each a feature more than the one before. */
static void chosen_variants_beat_one_for_everything_and_a_list_by_hand(void** state)
{
    (void)state;
    uint64_t random = 9u;
    hdrp_cull_feature_count sets[60];
    for (int t = 0; t < 10; ++t) {
        hdrp_cull_cost_model model = make_model(&random, true);
        hdrp_cull_choice_desc desc = {0};
        hdrp_cull_choice choice;
        hdrp_cull_variant_total worst = {0}, hand = {0}, chosen = {0};
        uint32_t masks[8], all;
        hdrp_cull_variant_list list = {&all, NULL, 1u};
        desc.sets = sets;
        desc.set_count = make_sets(&random, sets, 60u, 12u, VARIATIONS, true);
        desc.variant_limit = 8u;
        desc.cost = hdrp_cull_model_cost;
        desc.user = &model;
        all = hdrp_cull_all_features(sets, desc.set_count);
        assert_int_equal(
            hdrp_cull_report_variants(&list, sets, desc.set_count, desc.cost, &model, NULL, &worst),
            HDRP_OK);
        for (uint32_t r = 0u; r < 8u; ++r) {
            masks[r] = r == 7u ? all : all & ((1u << (5u + r)) - 1u);
        }
        list.masks = masks;
        list.count = 8u;
        assert_int_equal(
            hdrp_cull_report_variants(&list, sets, desc.set_count, desc.cost, &model, NULL, &hand),
            HDRP_OK);
        assert_int_equal(choose(&desc, &choice), HDRP_OK);
        list.masks = choice.masks;
        list.count = choice.variant_count;
        assert_int_equal(hdrp_cull_report_variants(&list, sets, desc.set_count, desc.cost, &model,
                                                   NULL, &chosen),
                         HDRP_OK);
        assert_true(chosen.uncovered == 0u);
        assert_true(fabs(chosen.cost - choice.total_cost) <= 1e-12 * chosen.cost);
        assert_true(chosen.cost < hand.cost && hand.cost < worst.cost);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_choices_cost_as_little_as_the_best_of_all),
        cmocka_unit_test(a_cost_that_is_not_monotone_gets_the_best_of_all_unions),
        cmocka_unit_test(a_set_that_costs_more_than_its_union_with_others_is_noticed),
        cmocka_unit_test(hard_choices_are_those_of_an_integer_program),
        cmocka_unit_test(usual_histograms_are_solved_and_proven),
        cmocka_unit_test(large_histograms_end_within_two_percent_of_their_bound),
        cmocka_unit_test(it_does_not_matter_whether_there_is_room_for_all_unions),
        cmocka_unit_test(as_many_variants_as_sets_cost_what_the_sets_cost),
        cmocka_unit_test(extreme_histograms_have_a_choice),
        cmocka_unit_test(the_order_of_sets_and_the_contents_of_memory_do_not_matter),
        cmocka_unit_test(little_effort_gives_a_valid_choice_and_a_valid_bound),
        cmocka_unit_test(what_cannot_be_chosen_from_is_refused),
        cmocka_unit_test(a_cost_model_adds_features_and_counts_whole_waves),
        cmocka_unit_test(a_report_weighs_what_variants_serve_and_carry_in_vain),
        cmocka_unit_test(chosen_variants_beat_one_for_everything_and_a_list_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
