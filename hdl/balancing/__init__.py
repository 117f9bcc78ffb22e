"""The next picture's table of regions, made in hardware of what was counted in the last one."""
