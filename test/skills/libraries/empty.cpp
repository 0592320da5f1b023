/// A library without any class of actions.
extern "C" int NothingOfInterest() { return 0; }
