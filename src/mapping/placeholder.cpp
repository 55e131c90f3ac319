namespace mstsl {}
