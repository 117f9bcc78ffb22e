"""One scene on several cages: pictures, clocks, what nodes send, memory."""
