"""Hand formulas beside the engine: quantities, comparison, catalogue, reports."""
