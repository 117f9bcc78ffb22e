"""What one machine costs for one scene: by model, or simulated."""
