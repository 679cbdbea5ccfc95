"""Cases go to whichever process is free, in their order, and none begins after the time is over."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from threading import Event

from diagnosis.prove.pool import in_turn


def test_a_long_case_does_not_hold_back_those_after_it() -> None:
    others = [Event() for _ in range(3)]

    def answer(case: int) -> bool:
        if case:
            others[case - 1].set()
            return True
        return all(event.wait(20.0) for event in others)

    with ThreadPoolExecutor(2) as pool:

        def submit(case: int) -> Future[bool]:
            return pool.submit(answer, case)

        found = [(case, done.result()) for case, done in in_turn(submit, range(4), 2, 60.0)]
    assert sorted(found) == [(case, True) for case in range(4)]
    assert [case for case, _ in found if case] == [1, 2, 3]


def test_no_more_run_at_once_than_jobs_and_none_begins_when_the_time_is_over() -> None:
    begun: list[int] = []

    def submit(case: int) -> Future[int]:
        begun.append(case)
        done: Future[int] = Future()
        done.set_result(case)
        return done

    running = in_turn(submit, range(5), 2, 60.0)
    next(running)
    assert begun == [0, 1]
    running.close()
    begun.clear()
    assert list(in_turn(submit, range(5), 2, 0.0)) == [] and begun == []
