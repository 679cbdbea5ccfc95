"""The paper's linear two blocks on rubber (Eq. 6, corrected), piecewise linear and solved exactly."""
