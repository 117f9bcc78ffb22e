"""What the component tests share: a clocked bench, stream agents, memory and picture models."""
