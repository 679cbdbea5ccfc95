"""Linear equations of a few unknowns within compiled code.

numpy's takes a fifth of the time in which such a program compiles. The models have their own, which programs that
check them do not share.
"""

from __future__ import annotations

from numba import njit


@njit
def solved(matrix, right):  # type: ignore[no-untyped-def]
    """x of matrix x = right, (n, n) and (n,): Gauss's elimination, rows exchanged for the largest pivot.

    Both are overwritten; nan or infinite where the matrix is singular.
    """
    n = right.size
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if pivot != k:
            for j in range(n):
                matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
            right[k], right[pivot] = right[pivot], right[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k + 1, n):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            right[i] -= matrix[i, j] * right[j]
        right[i] /= matrix[i, i]
    return right
