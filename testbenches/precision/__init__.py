"""Speed against error of a scene's machine: the study, its table, plot and report."""
