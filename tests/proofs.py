"""Long tests that `make proofs` runs; shorter ones of the same, or other cases, are among those of `make test`."""

from __future__ import annotations

RECOVERED = {
    "stack": (
        "pivot_inset viscous_damping coulomb_damping table_pitch tilt eccentricity accelerometer_offset gain offset "
        "delay clock filter base_filter base_gain drift saturation cross_axis"
    ),
    "wall": (
        "vertical_acceleration tilt eccentricity contact_length added_stiffness table_pitch viscous_damping "
        "coulomb_damping degradation hardening locking bouc_wen mullins permanent_set bonded_layer "
        "one_sided_stiffness interface_shear wall_flexibility "
        "accelerometer_offset gain delay clock filter base_filter base_gain drift saturation cross_axis"
    ),
}
"""Effects on two blocks and on walls; `tests/diagnosis/search/test_recovery_*.py` have others."""
PIECEWISE = "crushes driven fades housner_pitched in_a_table interface rubs stacked_pitched"
"""Runs that are cut by the plain reference too; `tests/models/test_piecewise.py` has others."""
PROOFS = (
    "benchmarks/test_base_cases.py::test_a_case_is_read_as_it_was_made[block]",
    "benchmarks/test_base_cases.py::test_a_case_is_read_as_it_was_made[stack]",
    "benchmarks/test_base_cases.py::test_a_case_is_read_as_it_was_made[stack_as_block]",
    "benchmarks/test_diagnosis_bench.py::test_cases_from_making_to_figures[diagnosed]",
    "benchmarks/test_faults.py::test_a_fault_does_no_harm[block swapped]",
    "benchmarks/test_faults.py::test_a_fault_does_no_harm[cube.nc a link]",
    "benchmarks/test_faults.py::test_a_fault_does_no_harm[three runs of one study at once]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[added_stiffness+viscous_damping]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[bouc_wen]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[coulomb_damping1]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[hardening]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[mullins]",
    "diagnosis/answer/test_building.py::test_a_sum_of_two_hysteretic_elements_is_told_from_one",
    "diagnosis/answer/test_diagnose.py::test_ctrl_c_after_the_search_leaves_the_answer[before and after]",
    "diagnosis/answer/test_diagnose.py::test_ctrl_c_after_the_search_leaves_the_answer[bootstrap]",
    "diagnosis/answer/test_law_replaces.py::test_a_law_takes_the_place_of_a_dashpot",
    "diagnosis/answer/test_law_replaces.py::test_a_rival_that_cannot_be_cut_at_an_instant_ends_no_answer",
    "diagnosis/answer/test_law_replaces.py::test_a_support_that_moves_takes_the_place_of_what_was_named",
    "diagnosis/answer/test_located.py::test_a_wrong_law_of_impacts_acts_at_impacts[effect1]",
    "diagnosis/answer/test_ranges.py::test_an_effect_within_its_range_is_not_questioned[1.0]",
    "diagnosis/data/test_placed.py::test_a_load_cell_weighs_the_block",
    "diagnosis/errors/test_errors.py::test_the_model_is_adequate_where_nothing_is_missing[autoregressive]",
    "diagnosis/errors/test_likelihood.py::test_what_is_absent_stays_at_its_bound[2]",
    "diagnosis/errors/test_likelihood.py::test_what_is_absent_stays_at_its_bound[3]",
    "diagnosis/fit/test_growing.py::test_a_whole_diagnosis_compares_what_can_be_followed",
    "diagnosis/forces/test_varying.py::test_a_force_in_some_windows_is_seen_and_one_in_all_is_not[stiffness]",
    "diagnosis/outcomes/test_chain.py::test_outcomes_turned_round_are_not_explained_and_asked_about",
    "diagnosis/report/test_names.py::test_an_answer_is_written_whatever_its_recordings_are_called[names1]",
    "diagnosis/search/test_beginnings.py::test_a_law_of_impacts_that_changes_is_found_where_the_base_bends_to_the_mean[0.92-5.0]",
    "diagnosis/search/test_beginnings.py::test_one_of_two_effects_begins_and_the_other_acts_always",
    "diagnosis/search/test_beginnings.py::test_the_strongest_against_white_noise_is_taken_along",
    "diagnosis/search/test_beginnings.py::test_what_begins_early_is_found_where_it_explains_most_acting_always",
    "diagnosis/search/test_beginnings.py::test_what_begins_in_the_second_recording_is_named_with_its_instant[offset",
    "diagnosis/search/test_driven.py::test_a_support_that_moves_and_a_mass_that_swings_are_told_apart[force",
    "diagnosis/search/test_grown.py::test_a_second_effect_that_grown_windows_ask_for_is_added",
    "diagnosis/search/test_in_each.py::test_what_acts_for_a_moment_in_every_test_is_a_blow",
    "diagnosis/search/test_ladder.py::test_what_rocks_on_the_block_is_found_where_it_stands[False]",
    "diagnosis/search/test_law.py::test_what_was_named_rightly_does_not_give_way_to_a_law",
    "diagnosis/search/test_law_of_walls.py::test_a_law_on_one_side_is_found_and_predicts[hidden1",
    "diagnosis/search/test_over_ranges.py::test_a_fit_with_an_effect_leaves_the_valley_of_a_base_that_went_astray[powers1]",
    "diagnosis/search/test_over_ranges.py::test_a_fit_with_an_effect_leaves_the_valley_of_a_base_that_went_astray[powers2]",
    "diagnosis/search/test_over_ranges.py::test_the_leading_single_and_what_an_exchange_finds_start_anew_over_the_ranges",
    "diagnosis/search/test_pairs.py::test_an_offset_behind_an_ac_coupling_is_told_from_a_lean",
    "diagnosis/search/test_recovery_linear.py::test_a_simulated_effect_is_seen_and_recovered[pivot_inset",
    "diagnosis/search/test_recovery_linear.py::test_layers_are_recovered_from_both_rotations",
    "diagnosis/search/test_variants.py::test_the_likeliest_order_is_taken_and_its_interval_holds_those_that_fit_as_well[10.0",
    "grids/motions/test_artificial.py::test_every_motion_reaches_the_spectrum[2-C-7]",
    "models/housner/test_free_rocking.py::test_peaks_of_free_rocking[newmark]",
    "models/housner/test_thresholds.py::test_brackets_of_the_other_integrators[0.2-shaking1-3.53181386758823-True-newmark]",
    "models/housner/test_thresholds.py::test_brackets_of_the_other_integrators[0.25-shaking2-7.434272303919999-False-newmark]",
    "models/interface/test_effects.py::test_a_bending_wall_that_is_turned_starts_straight[reference-1000.0-0.06]",
    "models/interface/test_lanes.py::test_lanes_agree_with_the_reference_on_random_walls[toe_held",
    "models/interface/test_reference.py::test_free_rocking_without_dashpots_conserves_energy[midpoint_held]",
    "models/isolated/test_lanes.py::test_lanes_agree_with_the_reference_on_random_buildings[12]",
    "models/isolated/test_lanes.py::test_lanes_agree_with_the_reference_on_random_buildings[1]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[hardening]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[locking]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[mullins]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[permanent_set]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[bouc_wen]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[hardening]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[locking]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[mullins]",
    "models/rubber/test_energy.py::test_springs_that_only_store_lose_nothing[hardening]",
    "models/rubber/test_energy.py::test_springs_that_only_store_lose_nothing[locking]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[bouc_wen]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[hardening]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[locking]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[maxwell]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[mullins]",
    "models/rubber/test_locking.py::test_what_no_step_tells_of_a_wall_on_layers_that_lock_early_is_not_converged[0.3]",
    "models/stacked/test_free_rocking.py::test_mirrored_shaking_gives_the_mirrored_response[reference]",
    "models/stacked/test_lanes.py::test_lanes_agree_with_the_reference[False-0.0]",
    "models/stacked/test_lanes.py::test_lanes_agree_with_the_reference[True-0.6]",
    "models/test_answers.py::test_outputs[reference-stacked]",
    *(f"models/test_piecewise.py::test_a_cut_run_is_the_whole_run[{run}-reference]" for run in PIECEWISE.split()),
    "models/test_peaks.py::test_the_reference_gives_the_same[isolated]",
    "study/test_large_cube.py::test_a_table_in_parts_is_the_whole_table[1]",
    "study/test_schedulers.py::test_the_other_models_lose_nothing_either[interface_linear]",
    "study/test_schedulers.py::test_the_other_models_lose_nothing_either[isolated]",
    "study/test_schedulers.py::test_the_other_models_lose_nothing_either[stacked]",
    *(
        f"diagnosis/search/test_recovery_{model}.py::{test}[{effect}]"
        for model, effects in RECOVERED.items()
        for effect in effects.split()
        for test in (
            "test_a_simulated_effect_is_seen_and_recovered",
            "test_the_direction_of_the_score_is_a_finite_difference",
        )
    ),
)
"""Beginnings of their names."""
