"""Which tests are slow, and which are long proofs beside a reduced version of themselves.

``pytest -m "not slow"`` takes about two minutes with compiled kernels; ``make test`` leaves the proofs to
``make proofs``.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# tests run beside each other: more threads a process cost more than they give; read when numpy is imported
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# how long an example takes says something of the machine's load, nothing of the code
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")

HERE = Path(__file__).resolve().parent
SLOW = (
    "benchmarks",
    "diagnosis/answer",
    "diagnosis/data/test_noise.py",
    "diagnosis/errors",
    "diagnosis/fit",
    "diagnosis/forces",
    "diagnosis/report/test_names.py",
    "diagnosis/search",
    "grids/motions/test_artificial.py",
    "models/housner/test_agreement.py",
    "models/housner/test_convergence.py",
    "models/housner/test_thresholds.py",
    "models/interface/test_effects.py",
    "models/interface/test_lanes.py",
    "models/interface/test_limits.py",
    "models/interface/test_reference.py",
    "models/interface/test_small_motions.py",
    "models/interface_linear/test_lanes.py",
    "models/isolated/test_lanes.py",
    "models/isolated/test_laws.py",
    "models/isolated/test_study.py",
    "models/lanes/test_sealed_cache.py",
    "models/mechanisms/test_agreement.py",
    "models/mechanisms/test_regimes.py",
    "models/rubber",
    "models/stacked/test_free_rocking.py",
    "models/stacked/test_lanes.py",
    "models/test_piecewise.py",
    "rocking/test_data_logger.py",
    "rocking/test_diagnose.py",
    "rocking/test_example.py",
    "study/test_partitions.py",
    "study/test_schedulers.py",
)
"""Files and folders that fit recordings, compare whole families of runs, or compile a kernel of their own."""
PROOFS = (
    "benchmarks/test_base_cases.py::test_a_case_is_read_as_it_was_made[block]",
    "benchmarks/test_base_cases.py::test_a_case_is_read_as_it_was_made[stack_as_block]",
    "benchmarks/test_faults.py::test_a_fault_does_no_harm[block swapped]",
    "benchmarks/test_faults.py::test_a_fault_does_no_harm[cube.nc a link]",
    "benchmarks/test_faults.py::test_a_fault_does_no_harm[three runs of one study at once]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[added_stiffness+viscous_damping]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[bouc_wen]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[hardening]",
    "benchmarks/test_fibre_wall.py::test_both_programs_move_a_wall_alike[mullins]",
    "diagnosis/answer/test_diagnose.py::test_ctrl_c_after_the_search_leaves_the_answer[before and after]",
    "diagnosis/answer/test_diagnose.py::test_ctrl_c_after_the_search_leaves_the_answer[bootstrap]",
    "diagnosis/report/test_names.py::test_an_answer_is_written_whatever_its_recordings_are_called[names1]",
    "diagnosis/search/test_beginnings.py::test_a_law_of_impacts_that_changes_is_found_where_the_base_bends_to_the_mean[0.92-5.0]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[coulomb_damping]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[coulomb_damping]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[table_pitch]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[table_pitch]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[tilt]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[tilt]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[eccentricity]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[eccentricity]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[accelerometer_offset]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[accelerometer_offset]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[gain]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[gain]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[offset]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[offset]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[delay]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[delay]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[clock]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[clock]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[filter]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[filter]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[base_filter]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[base_filter]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[base_gain]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[base_gain]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[drift]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[drift]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[saturation]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[saturation]",
    "diagnosis/search/test_recovery_stack.py::test_a_simulated_effect_is_seen_and_recovered[cross_axis]",
    "diagnosis/search/test_recovery_stack.py::test_the_direction_of_the_score_is_a_finite_difference[cross_axis]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[vertical_acceleration]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[vertical_acceleration]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[tilt]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[tilt]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[eccentricity]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[eccentricity]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[contact_length]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[contact_length]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[added_stiffness]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[added_stiffness]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[table_pitch]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[table_pitch]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[viscous_damping]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[viscous_damping]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[coulomb_damping]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[coulomb_damping]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[degradation]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[degradation]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[hardening]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[hardening]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[locking]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[locking]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[bouc_wen]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[bouc_wen]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[mullins]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[mullins]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[permanent_set]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[permanent_set]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[bonded_layer]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[bonded_layer]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[accelerometer_offset]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[accelerometer_offset]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[gain]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[gain]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[delay]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[delay]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[clock]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[clock]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[filter]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[filter]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[base_filter]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[base_filter]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[base_gain]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[base_gain]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[drift]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[drift]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[saturation]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[saturation]",
    "diagnosis/search/test_recovery_wall.py::test_a_simulated_effect_is_seen_and_recovered[cross_axis]",
    "diagnosis/search/test_recovery_wall.py::test_the_direction_of_the_score_is_a_finite_difference[cross_axis]",
    "models/interface/test_effects.py::test_a_bending_wall_that_is_turned_starts_straight[reference-1000.0-0.06]",
    "models/interface/test_lanes.py::test_lanes_agree_with_the_reference_on_random_walls[toe_held",
    "models/interface/test_reference.py::test_free_rocking_without_dashpots_conserves_energy[midpoint_held]",
    "models/isolated/test_lanes.py::test_lanes_agree_with_the_reference_on_random_buildings[1]",
    "models/isolated/test_lanes.py::test_lanes_agree_with_the_reference_on_random_buildings[12]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[hardening]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[locking]",
    "models/rubber/test_energy.py::test_a_fibre_never_gives_back_more_than_it_took[mullins]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[hardening]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[locking]",
    "models/rubber/test_energy.py::test_both_routes_move_and_dissipate_alike[mullins]",
    "models/rubber/test_energy.py::test_springs_that_only_store_lose_nothing[locking]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[bouc_wen]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[hardening]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[locking]",
    "models/rubber/test_laws.py::test_a_shaken_random_wall_and_its_values_agree_with_the_reference[mullins]",
    "models/rubber/test_locking.py::test_what_no_step_tells_of_a_wall_on_layers_that_lock_early_is_not_converged[0.3]",
    "models/stacked/test_lanes.py::test_lanes_agree_with_the_reference[False-0.0]",
    "models/stacked/test_lanes.py::test_lanes_agree_with_the_reference[True-0.6]",
    "models/test_answers.py::test_outputs[reference-stacked]",
    "models/test_peaks.py::test_the_reference_gives_the_same[isolated]",
    "study/test_large_cube.py::test_a_table_in_parts_is_the_whole_table[1]",
    "study/test_schedulers.py::test_the_other_models_lose_nothing_either[interface_linear]",
    "study/test_schedulers.py::test_the_other_models_lose_nothing_either[isolated]",
    "study/test_schedulers.py::test_the_other_models_lose_nothing_either[stacked]",
)
"""Beginnings of the names of long cases of tests; other cases of the same test stay with the others."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    slow = [HERE / path for path in SLOW]
    for item in items:
        if item.nodeid.removeprefix("tests/").startswith(PROOFS):
            item.add_marker(pytest.mark.proof)
        if any(item.path == path or path in item.path.parents for path in slow):
            item.add_marker(pytest.mark.slow)
    # short files last: of two processes neither waits long for the other
    items.sort(key=lambda item: item.get_closest_marker("slow") is None)
